// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "versine/core/time.hpp"

namespace versine {

/// Samples of one sensor in order of time. A sample is a struct with a member `Time time`.
/// Readers may hold times as recorded, in any order; after sensors' integrity check `strictly_increasing()` holds,
/// and every algorithm behind that check requires it.
template <class Sample>
struct Series {
  TimeScale scale = TimeScale::recorder;
  std::vector<Sample> samples;

  [[nodiscard]] bool empty() const { return samples.empty(); }
  [[nodiscard]] std::size_t size() const { return samples.size(); }
  [[nodiscard]] const Sample& operator[](std::size_t i) const { return samples[i]; }
  [[nodiscard]] Sample& operator[](std::size_t i) { return samples[i]; }
  [[nodiscard]] auto begin() const { return samples.begin(); }
  [[nodiscard]] auto end() const { return samples.end(); }
  [[nodiscard]] const Sample& front() const { return samples.front(); }
  [[nodiscard]] const Sample& back() const { return samples.back(); }

  [[nodiscard]] bool strictly_increasing() const {
    return std::adjacent_find(begin(), end(), [](const Sample& a, const Sample& b) { return !(a.time < b.time); }) ==
           end();
  }
  /// Index of the first sample with `time >= t`; size() when there is none. REQUIRES strictly_increasing().
  [[nodiscard]] std::size_t lower_bound(Time t) const {
    const auto it = std::lower_bound(begin(), end(), t, [](const Sample& s, Time x) { return s.time < x; });
    return static_cast<std::size_t>(it - begin());
  }
  /// Samples with `from <= time < to`. REQUIRES strictly_increasing().
  [[nodiscard]] std::span<const Sample> between(Time from, Time to) const {
    const std::size_t a = lower_bound(from), b = std::max(a, lower_bound(to));
    return {samples.data() + a, b - a};
  }
};

}  // namespace versine
