// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "versine/fusion/landmark_model.hpp"
#include "versine/fusion/planning.hpp"
#include "versine/sensors/imu_grade.hpp"

/// Accuracy of a survey that is only planned: covariance of landmark dead reckoning over chained intervals, which share
/// what they learn about gyro, heading and odometer. No measurement is needed for it.
namespace versine::fusion {

/// A survey by sensors and habits. SI and radians; standard deviations are one sigma.
struct PlanCase {
  sensors::TriadErrors gyro;           ///< bias as it is at switch-on; random walks
  sensors::TriadErrors accelerometer;  ///< for the comparison with inertial methods
  double level = 0.0;                  ///< equivalent level error at the start, with the mounting's
  double landmark = 0.0;               ///< m, each direction
  double spacing = 60.0;               ///< m
  int intervals = 5;
  double speed = 1.0;  ///< m/s
  double stand = 0.0;  ///< s at each landmark
  double latitude = 0.0;
  double heading = 0.0;        ///< of the track
  double scale = 0.002;        ///< odometer scale error at the start
  double scale_walk = 8e-6;    ///< 1/sqrt(s)
  double path_walk = 0.0;      ///< m/sqrt(m), wheels against their direction, lateral and vertical
  double distance_walk = 0.0;  ///< m/sqrt(m), odometer
};

/// Section 5 of Jiang 2017 for a case: what gyrocompassing leaves, and the errors that drive the three directions.
struct DerivedErrors {
  double heading_error = 0.0;  ///< rad
  EquivalentBias bias;
  CrossErrors vertical, lateral;
  LongitudinalErrors longitudinal;
};
[[nodiscard]] DerivedErrors derive(const PlanCase& plan);

/// Three directions of the track at once.
struct Directions {
  double lateral = 0.0, vertical = 0.0, longitudinal = 0.0;
  [[nodiscard]] double worst_cross() const { return lateral > vertical ? lateral : vertical; }
};

/// Standard deviations, m, by the closed forms: one interval by itself, from the start of the survey.
[[nodiscard]] Directions closed_form_sigma(const PlanCase& plan, double distance);
/// The largest along that interval.
[[nodiscard]] Directions closed_form_worst(const PlanCase& plan);

struct ProfilePoint {
  double distance = 0.0;  ///< m from the first landmark
  Directions sigma;       ///< m, smoothed
};

struct ChainAccuracy {
  std::vector<ProfilePoint> profile;
  Directions worst;           ///< of the whole run, ends included
  Directions worst_interior;  ///< of the interval in the middle of the run
  Directions versine;         ///< of a chord, at the worst place; longitudinal is 0
  Directions short_wave;      ///< of the 30 m check of EQUATIONS.md (5 m against 0.625 m steps); longitudinal is 0
};

/// Filter and RTS over the chained intervals; `chord` in m, 0: no versines.
[[nodiscard]] ChainAccuracy chain_accuracy(const PlanCase& plan, double chord = 30.0);

}  // namespace versine::fusion
