// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "versine/geodesy/projection.hpp"
#include "versine/geodesy/trajectory.hpp"

namespace versine::io {

/// A column of a written trajectory: its name with unit, its decimals in text, its value of a point.
struct TrajectoryColumn {
  const char* name;
  const char* unit;
  int decimals;
  double (*value)(const geodesy::TrajectoryPoint&, const struct PointView&);
};

/// What several columns of a point share, computed once.
struct PointView {
  double roll, pitch, heading;
  geodesy::MapPoint map;
};

/// The columns of trajectory.csv and trajectory.h5 behind the time, in order; docs/formats.md describes them.
[[nodiscard]] std::vector<TrajectoryColumn> trajectory_columns(bool with_map);
[[nodiscard]] PointView view_of(const geodesy::TrajectoryPoint& point, const geodesy::Projection* projection);
/// Indices of the points that are at least `interval` apart, every point of a new segment included.
[[nodiscard]] std::vector<std::size_t> decimated(const geodesy::Trajectory& trajectory, Duration interval);

}  // namespace versine::io
