// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "versine/core/series.hpp"
#include "versine/geodesy/geodetic.hpp"

/// What the sensors of a trolley or a vehicle deliver, in SI units and radians, axes forward-right-down, after io has
/// turned the file's own units, axes and clocks into these.
namespace versine::sensors {

/// Increments of an inertial measurement unit over the interval that ends at `time` and begins at the sample before.
/// The first sample of a series (and the first after a gap) covers the nominal interval.
struct ImuSample {
  Time time;
  Eigen::Vector3d dtheta = Eigen::Vector3d::Zero();  ///< integral of the angular rate of b against i, b-frame, rad
  Eigen::Vector3d dvel = Eigen::Vector3d::Zero();    ///< integral of the specific force, b-frame, m/s
};
/// What the samples of an ImuSeries hold. sensors::check_imu turns all of them into increments.
enum class ImuContent {
  increments,      ///< over the interval since the sample before
  mean_rates,      ///< rates, mean over that interval, times the nominal interval
  rates_at_stamp,  ///< rates at the stamp, times the nominal interval
};
struct ImuSeries : Series<ImuSample> {
  Duration interval;  ///< nominal sampling interval
  ImuContent content = ImuContent::increments;
};

enum class FixType { none, single, differential, float_ambiguity, fixed, dead_reckoned };

/// One GNSS epoch: the antenna's position and, where given, velocity.
struct GnssSample {
  Time time;
  geodesy::Geodetic position;                             ///< antenna, WGS84
  Eigen::Vector3d sigma_ned = Eigen::Vector3d::Zero();    ///< standard deviation north, east, down, m
  std::optional<Eigen::Vector3d> v_ned;                   ///< velocity relative to the Earth, m/s
  Eigen::Vector3d sigma_v_ned = Eigen::Vector3d::Zero();  ///< m/s, with v_ned
  FixType fix = FixType::single;
  int satellites = 0;  ///< 0: not told
  float ratio = 0;     ///< ambiguity ratio; 0: not told
};

/// Distance travelled since the start of the recording as the wheel tells it, signed by direction, m. A pulse counter
/// gives one sample a pulse or one a fixed interval; either way the filter uses increments between samples.
struct OdometerSample {
  Time time;
  double distance = 0.0;
};

/// Speed along the vehicle's forward axis, m/s, signed.
struct SpeedSample {
  Time time;
  double speed = 0.0;
};

/// What a landmark's error has in common with those of its neighbours, because the same control points went into them:
/// the shared part of the error is `root` u, with u of unit variance. Between two landmarks each element of u is alike
/// by exp(-|difference of `place`|), a Gauss-Markov process over the survey.
struct SharedError {
  /// Rows: position (given minus true, n-frame, m), phi-angle in n (rad). Its square is part of the landmark's
  /// covariance.
  Eigen::Matrix<double, 6, 6> root = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> place = Eigen::Matrix<double, 6, 1>::Zero();  ///< never falls along a series
};

/// A position known from outside while the vehicle stands: a total station on the trolley that found itself between
/// control points, a prism on the trolley seen from beside the track, or a marked point.
struct LandmarkSample {
  Time time;      ///< middle of the standstill
  Time from, to;  ///< the standstill
  std::string name;
  geodesy::Geodetic position;                            ///< of the instrument's centre or the prism
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< n-frame, m^2
  std::optional<Eigen::Quaterniond> q_ns;                ///< attitude of the instrument s, when it was solved for
  Eigen::Matrix3d attitude_covariance = Eigen::Matrix3d::Zero();  ///< of the phi-angle in n, rad^2, with q_ns
  /// Of the position's error (given minus true, n) with that phi-angle, m rad: both come from the same readings.
  Eigen::Matrix3d position_attitude = Eigen::Matrix3d::Zero();
  std::optional<SharedError> shared;  ///< none: independent of all other landmarks
};

/// Heading from a dual antenna or from a known track azimuth, rad from north clockwise.
struct HeadingSample {
  Time time;
  double heading = 0.0;
  double sigma = 0.0;
};

/// Raw reading of the track gauge sensor: the variable part of the gauge, m, with the sensor's temperature.
struct GaugeSample {
  Time time;
  double reading = 0.0;       ///< m
  double temperature = 20.0;  ///< deg C
};

/// Distance from the ultrasonic sensor down to whatever is below it, m: ballast or slab, or a sleeper.
struct RangeSample {
  Time time;
  double range = 0.0;
};

}  // namespace versine::sensors
