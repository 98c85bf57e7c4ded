// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/core/run_record.hpp"

namespace versine::io {

/// What a reader had to leave out of a text file, line by line, gathered into findings with time spans.
class FaultLog {
 public:
  /// The time of the sample read last; faults that follow are reported there.
  void now(Time time) {
    if (!started_) first_ = time, started_ = true;
    now_ = time;
  }
  /// A line that was left out. Faults of one kind in consecutive lines are one finding; after 100 findings the rest of
  /// a kind is counted in the last.
  void add(std::string_view kind, std::size_t line, std::string_view detail);

  [[nodiscard]] std::size_t count() const { return count_; }
  /// Appends one finding for each run of faults.
  void report(std::string_view sensor, RunRecord& record) const;
  /// An Error when so many lines were left out that the file can't be what it is taken for: more than one in ten.
  [[nodiscard]] Expected<void> tolerable(const std::string& file, std::size_t good_lines) const;

 private:
  struct Run {
    std::string kind, detail;
    std::size_t first_line, last_line, count;
    Time from, to;
    bool at_start;
  };
  std::vector<Run> runs_;
  std::size_t count_ = 0;
  Time now_, first_;
  bool started_ = false;
};

}  // namespace versine::io
