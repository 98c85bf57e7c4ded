// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <numbers>

/// Factors from units of the outside world to SI and radians. Used only where values enter or leave: io, app, report.
namespace versine::units {

inline constexpr double deg = std::numbers::pi / 180.0;
inline constexpr double arcsec = deg / 3600.0;
inline constexpr double gon = std::numbers::pi / 200.0;
inline constexpr double mgon = 1e-3 * gon;
inline constexpr double mm = 1e-3;
inline constexpr double km = 1e3;
inline constexpr double kmh = 1.0 / 3.6;
inline constexpr double hour = 3600.0;
inline constexpr double ppm = 1e-6;
inline constexpr double standard_gravity = 9.80665;           ///< m/s^2, "g" of data sheets
inline constexpr double mGal = 1e-5;                          ///< m/s^2
inline constexpr double deg_per_hour = deg / 3600.0;          ///< gyro bias
inline constexpr double deg_per_sqrt_hour = deg / 60.0;       ///< angle random walk
inline constexpr double mps_per_sqrt_hour = 1.0 / 60.0;       ///< velocity random walk

}  // namespace versine::units
