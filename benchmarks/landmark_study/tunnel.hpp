// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "scenario.hpp"
#include "versine/fusion/aided_ins.hpp"

namespace versine::study {

/// 5.2 km in one direction: straight, or three arcs of `radius` with `cant`; a landmark every `spacing`. Metres.
[[nodiscard]] simulation::Scenario tunnel_line(double radius, double cant, double spacing);

/// Lateral, vertical and longitudinal errors.
struct TunnelErrors {
  Squares straight, ramp, curve;
  /// Rows of a table.
  void print(const char* name) const;
};

[[nodiscard]] TunnelErrors judge(const geodesy::Trajectory& t, const simulation::SimulatedRecording& r,
                                 const simulation::Scenario& s);

/// Both methods on one recording.
struct Solved {
  simulation::SimulatedRecording recording;
  fusion::LandmarkSolution reckoned;
  fusion::AidedInsResult aided;
};

/// What calibration left of the mounting (rad) is known to the programs as its sigma only.
[[nodiscard]] Expected<Solved> solve(simulation::Scenario s, std::uint64_t seed, double mounting);

/// RMS of the difference of the two methods, lateral, vertical, longitudinal.
[[nodiscard]] Eigen::Array3d difference(const geodesy::Trajectory& a, const geodesy::Trajectory& b);
[[nodiscard]] double largest_model_error(const fusion::LandmarkSolution& s);

}  // namespace versine::study
