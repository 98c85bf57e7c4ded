// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "versine/core/time.hpp"
#include "versine/geodesy/geodetic.hpp"

namespace versine::inertial {

/// Position, velocity and attitude of the IMU's body frame b.
struct NavState {
  Time time;
  geodesy::Geodetic position;
  Eigen::Vector3d v_eb_n = Eigen::Vector3d::Zero();          ///< velocity relative to the Earth, n-frame, m/s
  Eigen::Quaterniond q_nb = Eigen::Quaterniond::Identity();  ///< attitude, b to n
};

/// What is known about the IMU's own errors, and taken off its output before it is used. A sensor measures
/// `(1 + scale) * truth + bias` on each axis (Chen 2018 eq. 3).
struct ImuCorrection {
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();            ///< rad/s
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();   ///< m/s^2
  Eigen::Vector3d gyro_scale = Eigen::Vector3d::Zero();           ///< 1
  Eigen::Vector3d accelerometer_scale = Eigen::Vector3d::Zero();  ///< 1
};

}  // namespace versine::inertial
