// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "adjustment.hpp"
#include "versine/core/error.hpp"

/// What lies behind readings that do not fit: the faults that happen, each tried in turn.
namespace versine::stationing {

/// Completes `error` (no start value found) with the fault that would explain it: angles in another unit, easting and
/// northing exchanged, points on a line.
Error diagnose_start(std::span<const Pair> pairs, double tolerance, double largest_tilt, Error error);

/// A constant in all distances that the residuals show and that explains them.
struct DistanceError {
  double value = 0.0;  ///< m; positive: distances too long
  double test = 0.0;   ///< of the remaining residuals: sigma0
};
std::optional<DistanceError> common_distance_error(const std::vector<Observation>& observations,
                                                   const Adjustment& adjustment);

}  // namespace versine::stationing
