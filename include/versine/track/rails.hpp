// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "versine/track/mileage.hpp"

namespace versine::track {

/// One rail on the grid. Points are at the gauge corner (or head centre) in the plane of the running surfaces; heights
/// are those of the head centre.
struct RailLine {
  std::vector<Eigen::Vector3d> ecef;  ///< m; NaN in gaps
  std::vector<Eigen::Vector2d> map;   ///< easting, northing
  std::vector<double> height;         ///< ellipsoidal, m
  std::vector<float> fit_sigma;       ///< white part of the lateral position, m
};

/// Both rails on the grid, and what places them.
struct RailGrid {
  std::vector<double> mileage;
  RailLine left, right;
  std::vector<double> cross_level;   ///< m, left higher positive
  std::vector<double> sensed_gauge;  ///< m, from the chord A1-A2 to A3: not yet corrected for the curve; NaN: missing
  std::vector<double> map_scale;     ///< map metres per metre on the ground
  std::vector<std::uint32_t> epoch;  ///< of the trajectory, nearest in mileage
  std::vector<Time> time;
  std::vector<std::uint32_t> flags;
  bool reference_is_left = true;
};

/// Rails from the trolley's poses: the reference rail is the mean of what wheels A1 and A2 traced (so that errors of
/// the mounting's heading and pitch cancel), the other rail what A3 traced. Gauge: Chen 2018 eq. 1, median-filtered.
[[nodiscard]] RailGrid place_rails(const GeometryInput& input, const GeometryOptions& options,
                                   const geodesy::ProjectMap& projection, const RunMileage& run, Progress& progress);

}  // namespace versine::track
