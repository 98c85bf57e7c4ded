// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>

#include "versine/track/geometry.hpp"

/// Several runs over the same track (EN 13848-4).
namespace versine::track {

/// How far a run's mileage is off another's, piece by piece.
struct MileageShift {
  double mileage = 0.0;      ///< middle of the piece, m
  double shift = 0.0;        ///< add to the run's mileage, m
  double correlation = 0.0;  ///< there, -1 to 1
};
struct ShiftOptions {
  double window = 200.0;  ///< of a piece, m
  double largest = 3.0;   ///< shift that is looked for, m
  double weakest = 0.7;   ///< correlation below which a piece tells nothing
};
/// Shifts by the correlation of cross level and, where there are, gauge and versines; between grid points by a parabola
/// through the peak. REQUIRES the same step.
[[nodiscard]] std::vector<MileageShift> find_shifts(const Geometry& reference, const Geometry& run,
                                                    const ShiftOptions& options = {});
/// `run` on the grid of `reference`, its mileage moved by the shifts (interpolated between pieces).
[[nodiscard]] Geometry aligned_to(const Geometry& reference, const Geometry& run, std::span<const MileageShift> shifts);

/// Differences between two runs of one column.
struct Repeatability {
  std::string column;
  std::size_t count = 0;
  double mean = 0.0, rms = 0.0;  ///< of run minus reference, SI; rms about zero
  double p95 = 0.0;              ///< 95 % of |difference - mean| lie below
  double normalized = 0.0;       ///< rms of difference over its sigma from both runs; 1 is honest; NaN without sigma
};
/// Every column that both have, coordinates left out. Points flagged as band edge or without gauge are left out.
[[nodiscard]] std::vector<Repeatability> compare(const Geometry& reference, const Geometry& aligned);

}  // namespace versine::track
