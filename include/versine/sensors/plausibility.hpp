// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>

#include "versine/core/error.hpp"
#include "versine/core/run_record.hpp"
#include "versine/sensors/imu_check.hpp"
#include "versine/sensors/measurements.hpp"

/// Do the numbers make physical sense together? Catches what no single field shows: wrong units, wrong axes,
/// latitude and longitude swapped, recordings of different days.
namespace versine::sensors {

/// Where and when one sensor recorded, for messages and for the overlap.
struct Extent {
  std::string sensor;  ///< "imu"
  std::string file;
  TimeScale scale = TimeScale::gps;
  Time from, to;
};

/// The first extent is the one that counts (the IMU): every other must share a time span with it, on the same scale.
[[nodiscard]] Expected<void> check_overlap(std::span<const Extent> extents);

struct ImuPlausibilityOptions {
  std::string file;
  double max_tilt = 0.8;           ///< rad between the measured gravity and the b-frame's down axis
  double max_mean_rate = 2.0;      ///< rad/s, mean over a second, in the liveliest twentieth of the recording
  double max_standing_rate = 0.1;  ///< rad/s, mean over the calmest tenth of the recording
  double gyro_bias = 0.0;  ///< rad/s; sigma of the gyroscopes' bias: good ones must show the Earth's rate; 0: unknown
};

/// Gravity must have the right size (units) and lie along the down axis (axes); rates must be those of a vehicle
/// (degrees declared as radians). The Error names the declaration that would fit.
[[nodiscard]] Expected<RunRecord> check_imu_plausibility(const CheckedImu& imu, const ImuPlausibilityOptions& = {});

/// The turn that the gyroscopes measured against the turn of the course over ground: their ratio is 1 when units and
/// axes are right, -1 when latitude and longitude are swapped, 57.3 or 0.0175 when degrees and radians are. Also the
/// position differences against the velocities, when the receiver gives them. Says nothing when there is no turn.
[[nodiscard]] Expected<RunRecord> check_gnss_plausibility(const CheckedImu* imu, const Series<GnssSample>& gnss,
                                                          const std::string& file);

/// The way over ground of the positions against that of the odometer: where latitude and longitude are swapped it is
/// off by the cosine of one of them, even on a straight line. Says nothing below 20 m, nor where both ways round fit.
[[nodiscard]] Expected<void> check_gnss_way(const Series<GnssSample>& gnss, const Series<OdometerSample>& odometer,
                                            const std::string& file);

}  // namespace versine::sensors
