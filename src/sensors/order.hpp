// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/core/run_record.hpp"
#include "versine/core/series.hpp"

namespace versine::sensors {

/// Which samples stay so that the fewest are left out and the rest is strictly increasing: 1 kept, 2 a duplicate of
/// the time before, 0 out of order. A single stamp far ahead costs itself only, not all that follow.
[[nodiscard]] std::vector<char> order_of(std::span<const Time> times);

/// Findings of one kind; samples next to one another are one finding, after 100 the rest is counted in the last.
class FindingRuns {
 public:
  FindingRuns(std::string sensor, std::string kind, Finding::Action action)
      : sensor_(std::move(sensor)), kind_(std::move(kind)), action_(action) {}
  void add(std::size_t index, Time time, const std::string& detail = {});
  void append_to(RunRecord& record) const;
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  std::string sensor_, kind_;
  Finding::Action action_;
  std::vector<Finding> findings_;
  std::size_t last_ = 0, count_ = 0;
};

/// Leaves out duplicate and backward times. An Error when more than `max_disorder` of the samples are out of order.
template <class Sample>
Expected<void> put_in_order(std::vector<Sample>& samples, const std::string& sensor, const std::string& file,
                            double max_disorder, RunRecord& record);

Expected<void> too_much_disorder(std::size_t backward, std::size_t total, double max_disorder, const std::string& file);

template <class Sample>
Expected<void> put_in_order(std::vector<Sample>& samples, const std::string& sensor, const std::string& file,
                            double max_disorder, RunRecord& record) {
  std::vector<Time> times;
  times.reserve(samples.size());
  for (const Sample& s : samples) times.push_back(s.time);
  const std::vector<char> keep = order_of(times);
  if (keep.empty()) return {};
  FindingRuns duplicates(sensor, "duplicate time", Finding::Action::removed);
  FindingRuns backward(sensor, "backward time", Finding::Action::removed);
  std::size_t to = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (keep[i] == 2) duplicates.add(i, samples[i].time);
    if (keep[i] == 0) backward.add(i, samples[i].time);
    if (keep[i] != 1) continue;
    if (to != i) samples[to] = std::move(samples[i]);
    ++to;
  }
  samples.resize(to);
  duplicates.append_to(record);
  backward.append_to(record);
  return too_much_disorder(backward.count(), keep.size(), max_disorder, file);
}

}  // namespace versine::sensors
