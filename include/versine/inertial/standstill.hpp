// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "versine/sensors/measurements.hpp"

namespace versine::inertial {

struct Interval {
  Time from, to;
  [[nodiscard]] bool contains(Time t) const { return from <= t && t <= to; }
  [[nodiscard]] double seconds() const { return (to - from).seconds(); }
};

/// When a vehicle counts as standing. The limits are those of a trolley with its brake on or a car with its engine
/// running; an IMU noisier than they allow widens them by itself (see find_standstills).
struct StandstillOptions {
  double window = 1.0;   ///< s; each window is judged as a whole
  double minimum = 2.0;  ///< s; shorter standstills are not reported
  double margin = 0.3;   ///< s taken off both ends, where the vehicle still rocks
  /// m/s^2; standard deviation of the specific force in a window, each axis, and change of its mean since the first
  /// window of the standstill: a vehicle that sets off smoothly shows nothing else at first.
  double acceleration_spread = 0.05;
  double rate_spread = 0.003;    ///< rad/s; standard deviation of the angular rate in a window, each axis
  double rate_mean = 0.003;      ///< rad/s; mean angular rate beyond the gyro's bias
  double odometer_step = 0.002;  ///< m; the odometer may change by this much in a window; by twice in a standstill
  /// m/s; where GNSS tells a higher speed the vehicle does not stand, nor where its positions move by more than a
  /// window's way at that speed and three of their sigmas.
  double gnss_speed = 0.3;
};

/// What may be asked whether the vehicle stands; only the IMU must be there. With nothing but an IMU a smooth steady
/// ride can look like standing, so that give an odometer, a speed or GNSS whenever there is one.
struct StandstillInput {
  const sensors::ImuSeries* imu = nullptr;
  const Series<sensors::OdometerSample>* odometer = nullptr;
  const Series<sensors::SpeedSample>* speed = nullptr;
  const Series<sensors::GnssSample>* gnss = nullptr;
};

/// Standstills in order of time. The quietest tenth of the windows tells the IMU's own noise (white noise at its
/// sampling rate); limits below three times that are raised to it. REQUIRES strictly increasing series.
[[nodiscard]] std::vector<Interval> find_standstills(const StandstillInput& input,
                                                     const StandstillOptions& options = {});

}  // namespace versine::inertial
