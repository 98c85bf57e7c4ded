// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

#include "versine/core/error.hpp"
#include "versine/geodesy/trajectory.hpp"

namespace versine::app {

/// Root mean square, 95 % and largest magnitude of one component's differences, and the share of them inside 1.96
/// sigma (of both trajectories together). `in_sigmas` is the RMS of difference over sigma: 1 where sigmas are honest.
struct DifferenceStatistics {
  double rms = 0.0, p95 = 0.0, max = 0.0, coverage = 0.0, in_sigmas = 0.0;
};

/// Differences of a trajectory from a reference, in the reference's track axes: along its velocity, across (positive
/// to the right) and up; SI and radians. Where the reference stands its heading gives the axes.
struct TrajectoryComparison {
  std::size_t points = 0;
  DifferenceStatistics along, across, up, roll, pitch, heading;
};

/// Compares at the reference's times that lie inside the trajectory, interpolating; never across a gap. Points nearer
/// than `margin` seconds to an end of the trajectory are left out. Fails when nothing overlaps.
[[nodiscard]] Expected<TrajectoryComparison> compare_trajectories(const geodesy::Trajectory& trajectory,
                                                                  const geodesy::Trajectory& reference,
                                                                  double margin = 0.0);

}  // namespace versine::app
