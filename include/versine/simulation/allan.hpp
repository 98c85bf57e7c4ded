// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace versine::simulation {

/// Allan deviation of a rate at one averaging time.
struct AllanPoint {
  double tau = 0.0;        ///< averaging time, s
  double deviation = 0.0;  ///< in the unit of the rate
  std::size_t terms = 0;   ///< overlapping differences that entered
};

/// Overlapping Allan deviation (IEEE Std 952-1997 annex C) of increments (rate times interval) at a fixed interval,
/// s, at `per_decade` averaging times a decade from one interval to a quarter of the length. Cost: length times the
/// number of averaging times.
[[nodiscard]] std::vector<AllanPoint> allan_deviation(std::span<const double> increments, double interval,
                                                      int per_decade = 5);

/// White noise density (rate unit times sqrt(s)): deviation times sqrt(tau), weighted by the independent terms, over
/// the averaging times from `from` to `to`, s, where the curve falls with the slope -1/2. Zero when no point lies
/// there.
[[nodiscard]] double random_walk_of(std::span<const AllanPoint> curve, double from, double to);

/// Bias instability B: the lowest deviation over 0.664 among averaging times that at least `least_independent`
/// averages support (IEEE Std 952-1997).
[[nodiscard]] double bias_instability_of(std::span<const AllanPoint> curve, double total_time,
                                         double least_independent = 50.0);

}  // namespace versine::simulation
