// SPDX-License-Identifier: Apache-2.0
#include "versine/io/fault_log.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace versine::io {

void FaultLog::add(std::string_view kind, std::size_t line, std::string_view detail) {
  constexpr std::size_t most_runs = 100;
  ++count_;
  Run* last = nullptr;
  std::size_t of_kind = 0;
  for (Run& run : runs_) {
    if (run.kind == kind) last = &run, ++of_kind;
  }
  if (last != nullptr && (last->last_line + 1 >= line || of_kind >= most_runs)) {
    last->last_line = line;
    last->to = now_;
    ++last->count;
    return;
  }
  runs_.push_back({std::string(kind), std::string(detail), line, line, 1, now_, now_, !started_});
}

void FaultLog::report(std::string_view sensor, RunRecord& record) const {
  for (const Run& run : runs_) {
    std::string detail = run.first_line == run.last_line ? fmt::format("line {}", run.first_line)
                                                         : fmt::format("lines {} to {}", run.first_line, run.last_line);
    if (!run.detail.empty()) detail += ": " + run.detail;
    record.findings.push_back({.sensor = std::string(sensor),
                               .kind = run.kind,
                               .from = run.at_start ? first_ : run.from,
                               .to = run.at_start && run.to < first_ ? first_ : run.to,
                               .count = run.count,
                               .action = Finding::Action::removed,
                               .detail = detail});
  }
}

Expected<void> FaultLog::tolerable(const std::string& file, std::size_t good_lines) const {
  const std::size_t total = good_lines + count_;
  if (good_lines > 0 && (count_ <= 1 || 10 * count_ <= total)) return {};
  if (runs_.empty()) {
    return fail({.file = file,
                 .found = "no samples",
                 .expected = "at least one line of data",
                 .advice = "check whether the recorder or the copy was interrupted"});
  }
  const Run& worst =
      *std::max_element(runs_.begin(), runs_.end(), [](const Run& a, const Run& b) { return a.count < b.count; });
  return fail({.file = file,
               .line = worst.first_line,
               .found = fmt::format("{} of {} lines unusable, most: {}{}", count_, total, worst.kind,
                                    worst.detail.empty() ? "" : " (" + worst.detail + ")"),
               .expected = "at most one line in ten to be left out",
               .advice = "check the delimiter, the header and the columns' names and numbers against the file"});
}

}  // namespace versine::io
