// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/filter/linearized.hpp"
#include "versine/fusion/ins_state.hpp"

/// Measurement models of the aided INS, one file each under src/fusion/models. Each returns z (predicted minus
/// measured), H and R at the moment of the measurement, and knows nothing of the filter.
namespace versine::fusion {

/// Antenna position (Chen 2018 eq. 8), with the bias and the lever arm as states where they are estimated.
[[nodiscard]] filter::Linearized gnss_position(const InsMoment& m, const InsLayout& layout,
                                               const sensors::GnssSample& sample, const Eigen::Vector3d& sigma_ned);
/// Antenna velocity (Groves eq. 14.104). REQUIRES sample.v_ned.
[[nodiscard]] filter::Linearized gnss_velocity(const InsMoment& m, const InsLayout& layout,
                                               const sensors::GnssSample& sample, const Eigen::Vector3d& sigma_ned);
/// Reading of the odometer's distance counter.
[[nodiscard]] filter::Linearized odometer_distance(const InsMoment& m, const InsLayout& layout,
                                                   const sensors::OdometerSample& sample, double sigma);
/// Forward speed at the wheel with the odometer's scale factor (Chen 2018 eq. 12, first row).
[[nodiscard]] filter::Linearized forward_speed(const InsMoment& m, const InsLayout& layout,
                                               const sensors::SpeedSample& sample, double sigma);
/// Non-holonomic constraint: no velocity to the right and down at the wheel (Chen 2018 eq. 10 to 12).
[[nodiscard]] filter::Linearized constraint(const InsMoment& m, const InsLayout& layout, double sigma);
/// The constraint over a run: wheels that guide a beam along a rail are where its way has led, to the right and down.
/// REQUIRES the block `path`.
[[nodiscard]] filter::Linearized wheel_path(const InsMoment& m, const InsLayout& layout, double sigma);
/// The vehicle stands: no velocity of the IMU in n on the mean of the last `seconds`, though vibration and rocking give
/// it one at each moment. `mean`: what the estimate had. 0 s: at the moment itself. REQUIRES seconds short against the
/// change of the attitude's error (tens of seconds).
[[nodiscard]] filter::Linearized zero_velocity(const InsMoment& m, const InsLayout& layout, const Eigen::Vector3d& mean,
                                               double seconds, double sigma);
/// The vehicle stands: the mean rate of b against n is zero.
[[nodiscard]] filter::Linearized zero_rate(const InsMoment& m, const InsLayout& layout, double sigma);
/// Heading of the vehicle's forward axis.
[[nodiscard]] filter::Linearized vehicle_heading(const InsMoment& m, const InsLayout& layout, double heading,
                                                 double sigma);
/// Position of the instrument or prism on a standing vehicle, with its full covariance.
[[nodiscard]] filter::Linearized landmark_position(const InsMoment& m, const InsLayout& layout,
                                                   const sensors::LandmarkSample& sample,
                                                   const Eigen::Vector3d& lever_b);
/// Attitude of the instrument on a standing vehicle. REQUIRES sample.q_ns.
[[nodiscard]] filter::Linearized landmark_attitude(const InsMoment& m, const InsLayout& layout,
                                                   const sensors::LandmarkSample& sample,
                                                   const Eigen::Quaterniond& q_bs);
/// The same after the landmark's position went into the filter: less what that position has told of it already, so
/// that both together count with their full covariance.
[[nodiscard]] filter::Linearized landmark_attitude_after_position(const InsMoment& m, const InsLayout& layout,
                                                                  const sensors::LandmarkSample& sample,
                                                                  const Eigen::Vector3d& lever_b,
                                                                  const Eigen::Quaterniond& q_bs);

/// Velocity of the wheel point in the vehicle frame (Chen 2018 eq. 9), and its derivative with respect to all states.
struct WheelVelocity {
  Eigen::Vector3d v_v;
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor, 3, filter::max_states> H;
};
[[nodiscard]] WheelVelocity wheel_velocity(const InsMoment& m, const InsLayout& layout);

/// The moment with the velocity that a vehicle on its wheels has: at the wheel forward only, as fast as estimated. At
/// which velocity wheel models are linearised matters: at the estimate itself, whose sideways part is noise while the
/// vehicle stands, an odometer would seem to tell a heading (and the filter would believe a sigma of a quarter).
[[nodiscard]] InsMoment on_wheels(const InsMoment& m);

/// Rate of the odometer's reading, m/s, and its derivative: how its distance error grows.
struct DistanceRate {
  double rate = 0.0;
  Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, filter::max_states> H;
};
[[nodiscard]] DistanceRate distance_rate(const InsMoment& m, const InsLayout& layout);
/// The same, where the wheel's velocity is known already.
[[nodiscard]] DistanceRate distance_rate(const WheelVelocity& wheel, const InsMoment& m, const InsLayout& layout);

}  // namespace versine::fusion
