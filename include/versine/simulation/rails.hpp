// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <functional>

#include "versine/core/error.hpp"
#include "versine/geodesy/local_frame.hpp"
#include "versine/simulation/scenario.hpp"
#include "versine/simulation/spline.hpp"

namespace versine::simulation {

/// Both rails as curves in a local frame (north-east-down at `frame.origin()`) against the distance along the axis:
/// rows 0-2 the left rail, 3-5 the right one. A rail's point has the lateral place of the gauge corner and the height
/// of the running surface (track::Trolley).
struct Rails {
  geodesy::LocalFrame frame{geodesy::Geodetic{}};
  UniformSpline<6> curve;
  double step = 0.1;              ///< of the curve's grid, m; grid points are multiples of it
  double begin = 0.0, end = 0.0;  ///< distances between which a body may be, m
};

/// Deviations of the track model on a grid: spectrum, defects and table together.
[[nodiscard]] Deviations deviations(const TrackModel& track, double begin, double step, std::size_t count);

/// The rails of an alignment with its irregularities. The axis is brought from the map to the Earth point by point.
[[nodiscard]] Expected<Rails> build_rails(const TrackModel& track);

}  // namespace versine::simulation
