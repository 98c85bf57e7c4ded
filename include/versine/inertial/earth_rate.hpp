// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "versine/inertial/standstill.hpp"
#include "versine/sensors/imu_grade.hpp"

namespace versine::inertial {

/// The Earth's rotation as the gyros of a standing vehicle show it, nothing assumed about it.
struct EarthRate {
  Eigen::Vector3d omega_ib_b = Eigen::Vector3d::Zero();  ///< rad/s, b-frame of the start
  double vertical = 0.0;    ///< rad/s, its component along the mean specific force, positive up (north of the equator)
  double horizontal = 0.0;  ///< rad/s
  double sigma = 0.0;       ///< rad/s, of each component: unrest of the vehicle, and the gyros' bias
};

/// Slope of the attitude that the gyros add up over a standstill: a vehicle that people rock returns to where it was,
/// so that rocking is bounded in the attitude and its slope knows the rate far better than a mean of the rates does.
/// Nothing for less than 60 s.
[[nodiscard]] std::optional<EarthRate> measured_earth_rate(const sensors::ImuSeries& imu, const Interval& standing,
                                                           const sensors::ImuErrors& errors);

}  // namespace versine::inertial
