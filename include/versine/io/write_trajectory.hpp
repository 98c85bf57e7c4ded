// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>

#include "versine/core/error.hpp"
#include "versine/core/run_record.hpp"
#include "versine/fusion/solution.hpp"
#include "versine/geodesy/projection.hpp"
#include "versine/geodesy/trajectory.hpp"

namespace versine::io {

/// Columns besides the geodetic ones: easting and northing in the project's map.
struct TrajectoryOutput {
  const geodesy::Projection* projection = nullptr;  ///< none: no map columns
  Duration interval;                                ///< at least this long between points; zero: every point
};

/// `trajectory.csv`, columns as in docs/formats.md: 11 decimals of a degree (1 um), 0.01 mm in heights.
[[nodiscard]] Expected<void> write_trajectory_csv(const std::filesystem::path& path,
                                                  const geodesy::Trajectory& trajectory,
                                                  const TrajectoryOutput& output = {});
/// `trajectory.h5`: a group `smoothed`, and `forward` when the solution has one, each with one dataset a column and
/// its unit as attribute; `sensor_errors`; `innovations`. Times are int64 ns with the epoch as attribute.
[[nodiscard]] Expected<void> write_solution_hdf5(const std::filesystem::path& path, const fusion::Solution& solution,
                                                 const TrajectoryOutput& output = {});
/// One row a component of an innovation: time_s, sensor, component, innovation, sigma, nis, used.
[[nodiscard]] Expected<void> write_innovations_csv(const std::filesystem::path& path,
                                                   std::span<const fusion::Innovation> innovations, TimeScale scale);
/// One row a rejected measurement: time_s, sensor, reason, normalized, threshold.
[[nodiscard]] Expected<void> write_rejections_csv(const std::filesystem::path& path,
                                                  std::span<const Rejection> rejections, TimeScale scale);

}  // namespace versine::io
