// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "versine/core/time.hpp"

namespace versine::georef {

/// Errors of GNSS positions and speeds. A fix has a white part and a part correlated in time.
struct GnssModel {
  double scale = 1.5;            ///< receivers are optimistic: their sigmas times this
  double floor = 0.02;           ///< m, smallest sigma of a fix
  double correlated = 0.8;       ///< share of the sigma that is correlated in time
  double correlation_time = 15;  ///< s
  double nu = 4.0;               ///< degrees of freedom of Student's t for innovations
  double jump = 16.0;            ///< normalised innovation squared beyond which the correlated error began afresh
  double gate = 60.0;            ///< normalised innovation squared beyond which a fix is left out
  double map_sigma = 0.7;        ///< m, lateral error of the map
  double speed_scale = 2.0;      ///< speeds' sigmas times this
  double speed_floor = 0.05;     ///< m/s
  /// m, by FixType (none, single, differential, float, fixed, dead reckoned), where a fix tells no sigma. Not positive:
  /// not used.
  std::array<double, 6> sigma_of_type{0.0, 2.5, 1.0, 0.4, 0.05, 60.0};
};

/// How the speed changes in ways that no sensor tells: a first-order Gauss-Markov acceleration. With an IMU it is
/// the accelerometer's bias and the slope; without one it is the acceleration itself.
struct MotionModel {
  double sigma = 0.3;   ///< m/s^2
  double time = 30.0;   ///< s, correlation time
  double white = 0.02;  ///< m/s^2/sqrt(Hz): white noise of the acceleration
};

struct JourneyOptions {
  double shortest = 10.0;  ///< s
  double slowest = 1.0;    ///< m/s: the largest speed must exceed this
  double standing = 0.3;   ///< m/s: below this the vehicle may stand
  bool every_stop =
      false;  ///< a journey ends at every standstill; else only where the direction reverses (or may have)
  double longest_gap = 900;  ///< s without fixes within one journey
};

struct InferenceOptions {
  int paths = 16;           ///< hypotheses kept by the coarse search
  double radius = 30.0;     ///< m: tracks this near a fix are candidates (more where the fix's sigma is large)
  double farthest = 250.0;  ///< m: a fix farther from any track is off the map
  /// m: a fix with a larger sigma helps to find the path, but says nothing about the distance (a receiver's dead
  /// reckoning in a tunnel drifts by hundreds of metres, all in one direction).
  double largest_sigma = 30.0;
  double knot_distance = 15;  ///< m between fixes used by the coarse search
  double diverging = 0.3;     ///< prior probability of the diverging leg of a facing switch
  double top_speed = 90.0;    ///< m/s
};

enum class Linearisation { central_difference, unscented };

struct Options {
  GnssModel gnss;
  MotionModel with_imu{0.08, 60.0, 0.03}, without_imu{0.45, 12.0, 0.01};
  JourneyOptions journeys;
  InferenceOptions inference;
  Linearisation linearisation = Linearisation::central_difference;
  double jacobian_step = 4.0;                   ///< m
  double grid_with_imu = 0.01;                  ///< s
  double grid_without_imu = 0.1;                ///< s
  double smallest_probability = 1e-3;           ///< of a path that is smoothed and reported
  std::optional<Eigen::Vector3d> forward_axis;  ///< of the vehicle in the IMU's axes; none: found from the movement
  double turn_rate_sigma = 0.01;  ///< rad, of a change of azimuth: map and gyro together; used with an IMU that turns
  std::size_t threads = 1;        ///< for the paths of a journey; the result does not depend on it
};

/// What a reviewer decided: within [from, to] the vehicle was on these tracks only (or on none of them).
struct Constraint {
  std::string recording;  ///< Recording::name; empty: every recording
  Time from, to;
  std::vector<std::string> tracks;  ///< identifiers of tracks, or of lines of the map
  bool excluded = false;            ///< it was on none of them
  std::string comment;              ///< for people
};

}  // namespace versine::georef
