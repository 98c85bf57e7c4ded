// SPDX-License-Identifier: Apache-2.0
#include "order.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace versine::sensors {

namespace {
// Longest strictly increasing subsequence by patience sorting, O(n log n).
void keep_longest(std::span<const Time> times, std::vector<char>& keep) {
  std::vector<std::size_t> tails, index(times.size()), before(times.size());
  constexpr auto none = static_cast<std::size_t>(-1);
  std::vector<Time> tail_times;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (keep[i] == 2) continue;
    const auto at =
        static_cast<std::size_t>(std::lower_bound(tail_times.begin(), tail_times.end(), times[i]) - tail_times.begin());
    before[i] = at > 0 ? tails[at - 1] : none;
    if (at == tails.size()) {
      tails.push_back(i);
      tail_times.push_back(times[i]);
    } else if (times[i] < tail_times[at]) {  // of equal times the first stays
      tails[at] = i;
      tail_times[at] = times[i];
    }
  }
  for (char& k : keep) k = k == 2 ? 2 : 0;
  for (std::size_t i = tails.empty() ? none : tails.back(); i != none; i = before[i]) keep[i] = 1;
}
}  // namespace

std::vector<char> order_of(std::span<const Time> times) {
  if (std::adjacent_find(times.begin(), times.end(), [](Time a, Time b) { return !(a < b); }) == times.end()) return {};
  std::vector<char> keep(times.size(), 1);
  bool backward = false;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] == times[i - 1]) keep[i] = 2;
    backward = backward || times[i] < times[i - 1];
  }
  if (backward) keep_longest(times, keep);
  return keep;
}

void FindingRuns::add(std::size_t index, Time time, const std::string& detail) {
  ++count_;
  if (!findings_.empty() && (index == last_ + 1 || findings_.size() >= 100)) {
    Finding& f = findings_.back();
    f.from = std::min(f.from, time);
    f.to = std::max(f.to, time);
    ++f.count;
  } else {
    findings_.push_back(
        {.sensor = sensor_, .kind = kind_, .from = time, .to = time, .count = 1, .action = action_, .detail = detail});
  }
  last_ = index;
}

void FindingRuns::append_to(RunRecord& record) const {
  record.findings.insert(record.findings.end(), findings_.begin(), findings_.end());
}

Expected<void> too_much_disorder(std::size_t backward, std::size_t total, double max_disorder,
                                 const std::string& file) {
  if (backward <= 1 || static_cast<double>(backward) <= max_disorder * static_cast<double>(total)) return {};
  return fail({.file = file,
               .field = "time",
               .found = fmt::format("{} of {} samples with a time that goes back", backward, total),
               .expected = "times that increase, but for a few",
               .advice = "when the recorder was restarted, split the file there; when a week or a day begins anew, use "
                         "the columns tow_s or time_of_day_s, whose turns are followed"});
}

}  // namespace versine::sensors
