// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/fusion/solution.hpp"
#include "versine/sensors/measurements.hpp"
#include "versine/track/geometry.hpp"

namespace versine::app {

/// What is left between a landmark and the smoothed trajectory, for the report's page of control points.
struct LandmarkResidual {
  std::string name;
  Time time;
  std::optional<double> mileage;  ///< continuous, m; none without track geometry there
  bool used = true;               ///< false: the filter rejected it
  /// Landmark minus trajectory with its lever arm: north, east, up, m.
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma_landmark = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma_trajectory = Eigen::Vector3d::Zero();
};

/// Landmarks outside the trajectory or in a gap of it are left out. `geometry` may be null.
[[nodiscard]] std::vector<LandmarkResidual> landmark_residuals(const Series<sensors::LandmarkSample>& landmarks,
                                                               const fusion::Solution& solution,
                                                               const Eigen::Vector3d& lever_arm_b,
                                                               const track::Geometry* geometry);

/// `landmarks.csv`: name, time_s, distance_m and mileage_m (empty without geometry), used, residual_north_mm, ...,
/// sigma_landmark_north_mm, ..., sigma_trajectory_north_mm, ...
[[nodiscard]] Expected<void> write_landmark_residuals(const std::filesystem::path& path,
                                                      const std::vector<LandmarkResidual>& residuals,
                                                      const track::Geometry* geometry);

}  // namespace versine::app
