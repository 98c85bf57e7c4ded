// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "versine/core/error.hpp"
#include "versine/geodesy/geodetic.hpp"
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

/// Slope of the attitude of a level frame over a standstill, each second from the gyros' sum and the specific force:
/// how the vehicle leans on its springs, rocking or from one rest to another, is taken off, which neither a mean of the
/// rates nor the slope of the gyros' own sum does (on a real vehicle: people who got in and out leaned it by 0.15
/// degrees, 0.3 deg/h over half an hour). Nothing for less than 60 s.
[[nodiscard]] std::optional<EarthRate> measured_earth_rate(const sensors::ImuSeries& imu, const Interval& standing,
                                                           const sensors::ImuErrors& errors);

/// Whether the latitude that the Earth's rate tells, atan(vertical / horizontal), is that of the place: swapped
/// latitude and longitude show even in a recording without motion. Says nothing when the rate tells it to worse than 3
/// degrees. `file` is that of the positions, for the message.
[[nodiscard]] Expected<void> check_latitude(const EarthRate& rate, const geodesy::Geodetic& place,
                                            const std::string& file);

}  // namespace versine::inertial
