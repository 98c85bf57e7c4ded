// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>

#include "versine/core/run_record.hpp"
#include "versine/core/series.hpp"
#include "versine/geodesy/geodetic.hpp"
#include "versine/sensors/measurements.hpp"

namespace versine::georef {

/// A GNSS fix of a vehicle, with the scalar speed that low-cost receivers report.
struct Fix {
  Time time;
  geodesy::Geodetic position;
  double sigma = 0.0;           ///< m, of each horizontal axis, as the receiver says; 0: not told
  std::optional<double> speed;  ///< m/s over ground, never negative
  double sigma_speed = 0.0;     ///< m/s, with speed; 0: not told
  sensors::FixType type = sensors::FixType::single;
  int satellites = 0;
  Eigen::Vector2d place = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());  ///< place_on_map()
};

/// Rates of the vehicle's IMU at an instant, in its own axes; the mounting turns them forward-right-down.
struct InertialSample {
  Time time;
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< specific force, m/s^2
  Eigen::Vector3d turn_rate = Eigen::Vector3d::Zero();     ///< rad/s; zero when the file has none (has_turn_rate)
};

/// What one vehicle recorded between switching on and off.
struct Recording {
  std::string name;  ///< file or group
  Series<Fix> gnss;
  Series<InertialSample> imu;  ///< empty: GNSS only
  bool has_turn_rate = false;
  Series<sensors::SpeedSample> speed;  ///< odometer; may be empty
  RunRecord record;
};

/// Fixes from GNSS epochs: horizontal sigma as the root mean square of north and east, speed from the velocity.
[[nodiscard]] Series<Fix> to_fixes(const Series<sensors::GnssSample>& gnss);

}  // namespace versine::georef
