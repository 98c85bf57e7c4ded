// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/filter/kernels.hpp"
#include "versine/filter/state_blocks.hpp"
#include "versine/fusion/aided_ins.hpp"
#include "versine/inertial/nav_state.hpp"

namespace versine::fusion {

/// The error states of the aided INS: the 22 of Chen 2018 eq. 3, the odometer's distance (whose readings are then
/// independent, while increments between readings are not), and blocks that are there only when they are estimated.
/// Signs: position, velocity, attitude, distance are estimate minus truth (inertial/error_dynamics.hpp); everything
/// else is truth minus estimate.
struct InsLayout {
  filter::Block<3> position, velocity, attitude;
  filter::Block<1> distance;
  filter::Block<2> path;  ///< the wheels' way to the right and down: sum of what the constraint says is nothing
  filter::Block<3> gyro_bias, accelerometer_bias, gyro_scale, accelerometer_scale;
  filter::Block<1> odometer_scale;
  filter::Block<2> mounting;  ///< pitch and yaw: small rotation of v about its right and down axes
  filter::Block<3> gnss_lever, wheel_lever, gnss_bias;
  /// What the landmarks' errors share (sensors::SharedError): of positions, and with attitudes of these too. Unit
  /// variance.
  filter::Block<3> landmark_position, landmark_attitude;
  std::vector<std::string> names;

  [[nodiscard]] int moving() const { return path.enabled() ? filter::moving_with_path : filter::moving; }
  [[nodiscard]] int size() const { return static_cast<int>(names.size()); }
  [[nodiscard]] static InsLayout from(const AidedInsOptions& options,
                                      const Series<sensors::LandmarkSample>& landmarks = {});
};

/// Best estimate of everything that the error states are errors of.
struct InsEstimate {
  inertial::NavState nav;
  inertial::ImuCorrection imu;
  double distance = 0.0;                           ///< what the odometer should read, m
  Eigen::Vector2d path = Eigen::Vector2d::Zero();  ///< of the wheels to the right and down, m
  double odometer_scale = 0.0;                     ///< the odometer shows (1 + scale) times the way
  Eigen::Matrix3d C_vb = Eigen::Matrix3d::Identity();
  Eigen::Vector3d gnss_lever = Eigen::Vector3d::Zero(), wheel_lever = Eigen::Vector3d::Zero();
  Eigen::Vector3d gnss_bias = Eigen::Vector3d::Zero();                               ///< n-frame, m
  Eigen::Matrix<double, 6, 1> landmark_error = Eigen::Matrix<double, 6, 1>::Zero();  ///< u of sensors::SharedError
};

/// What holds at the moment of a measurement besides the estimate.
struct InsMoment {
  InsEstimate estimate;
  Eigen::Matrix3d C_nb = Eigen::Matrix3d::Identity();    ///< of estimate.nav.q_nb
  Eigen::Vector3d omega_ib_b = Eigen::Vector3d::Zero();  ///< rate of b against i, rad/s, corrected
  Eigen::Vector3d omega_nb_b = Eigen::Vector3d::Zero();  ///< rate of b against n, rad/s
};

/// The estimate with an error taken off it.
[[nodiscard]] InsEstimate without_error(const InsEstimate& estimate, const InsLayout& layout,
                                        const Eigen::Ref<const Eigen::VectorXd>& error);

}  // namespace versine::fusion
