// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/fusion/landmark_adjustment.hpp"
#include "versine/fusion/solution.hpp"

namespace versine::fusion::landmark {

/// From smoothed errors at the nodes to the trajectory of the IMU at every sample, or at the options' output rate:
/// corrections and covariances are interpolated between nodes, the nominal path in between is kept sample by sample.
/// Attitude is that of the trolley's direction of travel seen through the mounting: equivalent pitch and heading of
/// Jiang eq. 14. Velocity is that of the odometer's point.
[[nodiscard]] geodesy::Trajectory corrected_trajectory(const Reckoning& reckoning, const sensors::ImuSeries& imu,
                                                       const Smoothed& smoothed, double heading, double scale,
                                                       const LandmarkOptions& options);

/// The joint distribution of errors of the odometer's point (without what level and mounting do to the landmark's lever
/// arm, which shifts the whole run and no versine) every `interval` seconds: position, attitude, odometer scale,
/// equivalent gyro biases x y z, levelling.
[[nodiscard]] filter::ErrorChain error_chain(std::span<const Node> nodes, const Smoothed& smoothed, double heading,
                                             double interval);

/// Names and smoothed values of the sensor errors, every `interval` seconds.
[[nodiscard]] std::vector<std::string> sensor_error_names();
[[nodiscard]] std::vector<SensorErrorSample> sensor_errors(std::span<const Node> nodes, const Smoothed& smoothed,
                                                           const Eigen::Vector3d& rate_bias, double scale,
                                                           double interval);

}  // namespace versine::fusion::landmark
