// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/core/error.hpp"
#include "versine/core/progress.hpp"
#include "versine/fusion/landmark_observability.hpp"
#include "versine/fusion/landmark_options.hpp"
#include "versine/fusion/solution.hpp"
#include "versine/sensors/measurements.hpp"

/// Landmark dead reckoning (Jiang 2017): attitude from gyros after a standing start, distance from the odometer,
/// positions of landmarks whenever the trolley stands at one; no accelerometers in the position. A reduced error model
/// of 3 and 5 states, all of them observable, is filtered and smoothed over the whole run.
///
/// Valid for track that is nearly level and straight from one landmark to the next; landmark_validity.hpp puts numbers
/// to it, and docs/planning.md says where it ends.
namespace versine::fusion {

/// Recordings after the sensors' integrity checks. REQUIRES strictly increasing times on one clock.
struct LandmarkInput {
  const sensors::ImuSeries* imu = nullptr;
  const Series<sensors::OdometerSample>* odometer = nullptr;
  const Series<sensors::LandmarkSample>* landmarks = nullptr;
};

/// What became of a landmark.
struct LandmarkFit {
  std::string name;
  Time time;
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();  ///< smoothed position minus landmark, n-frame, m
  landmark::Fit fit;
};

struct LandmarkSolution {
  Solution solution;  ///< the bundle that every navigation method returns
  landmark::Observability observability;
  std::vector<LandmarkFit> landmarks;
  std::vector<landmark::Stretch> stretches;  ///< between landmarks: how far the reduced model holds
  double heading_correction = 0.0;           ///< rad, what the landmarks added to the aligned heading
};

/// Runs the method. Errors, each with its cure: fewer than two landmarks, a landmark taken in motion, no standing
/// start, no odometer, gaps while moving, landmarks that contradict each other.
[[nodiscard]] Expected<LandmarkSolution> run_landmark_dead_reckoning(const LandmarkInput& input,
                                                                     const LandmarkOptions& options,
                                                                     Progress& progress);

}  // namespace versine::fusion
