// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>

#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/sensors/imu_grade.hpp"

namespace versine::fusion {

/// An attitude of the trolley known from elsewhere, with standard deviations (rad).
struct GivenAttitude {
  geodesy::Euler attitude;
  double level_sigma = 0.0;
  double heading_sigma = 0.0;
};

enum class LandmarkSmoother { rts, two_filter };

/// Settings of landmark dead reckoning. SI and radians; standard deviations are one sigma.
struct LandmarkOptions {
  sensors::TriadErrors gyro;                ///< of the IMU's grade
  double alignment_duration = 900.0;        ///< s of the standing start used to align; less when it moves off earlier
  std::optional<double> heading;            ///< rad, of the trolley's x axis; instead of gyrocompassing
  double heading_sigma = 1.0 * units::deg;  ///< rad, of `heading`
  std::optional<GivenAttitude> attitude;    ///< at the first sample; then no standing start is needed
  double pitch_sigma = 0.005 * units::deg;  ///< rad, equivalent pitch at the start (level and mounting)
  double levelling_sigma = 0.003 * units::deg;  ///< rad, constant error of levelling (accelerometer bias over g)
  std::optional<double> bias_sigma;             ///< rad/s, equivalent gyro bias at the start; none: from `gyro`

  double scale_sigma = 0.002;        ///< of the odometer's scale factor at the start
  double scale_walk = 8e-6;          ///< 1/sqrt(s), its random walk (Jiang eq. 46)
  double distance_walk = 0.0;        ///< m/sqrt(m), random error of the odometer besides its scale
  double odometer_resolution = 0.0;  ///< m, one pulse: its rounding joins each landmark along the track
  double path_walk = 0.0;            ///< m/sqrt(m), wheels against the direction they point in

  geodesy::Euler mounting;                                   ///< IMU b in the trolley v: x_v = to_matrix(mounting) x_b
  double mounting_sigma = 0.2e-3;                            ///< rad, each angle, after calibration
  Eigen::Vector3d lever_odometer = Eigen::Vector3d::Zero();  ///< m, b-frame, from the IMU to the point that follows x_v
  Eigen::Vector3d lever_landmark = Eigen::Vector3d::Zero();  ///< m, b-frame, from the IMU to prism or total station

  LandmarkSmoother smoother = LandmarkSmoother::rts;
  double gate = 4.0;                   ///< largest normalised residual of a landmark that is used
  double standing_tolerance = 2e-3;    ///< m the odometer may show while the trolley stands
  bool skip_moving_landmarks = false;  ///< leave out a landmark taken in motion; otherwise it is an error
  double node_interval = 0.5;          ///< s between epochs of the filters; landmarks have their own
  double output_rate = 0.0;            ///< Hz of the trajectory; 0: every IMU sample
  double chain_interval = 1.0;         ///< s between epochs of Solution::chain; 0: no chain
  double model_error_limit = 0.3e-3;   ///< m; where the reduced model may be off by more, the run warns
};

}  // namespace versine::fusion
