// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>

#include "versine/core/error.hpp"
#include "versine/fusion/landmark_options.hpp"
#include "versine/geodesy/geodetic.hpp"
#include "versine/sensors/measurements.hpp"

namespace versine::fusion::landmark {

/// Attitude at the start of dead reckoning, and the rate that the standing gyros show beyond the Earth's.
struct StaticStart {
  std::size_t sample = 0;  ///< dead reckoning begins with this sample's attitude
  Eigen::Quaterniond q_nb = Eigen::Quaterniond::Identity();
  Eigen::Vector3d rate_bias = Eigen::Vector3d::Zero();  ///< b-frame, rad/s: with it the standing attitude holds still
  Eigen::Vector3d mean_rate = Eigen::Vector3d::Zero();  ///< b-frame, rad/s, of the standing gyros
  double latitude = 0.0;                                ///< rad
  double duration = 0.0;                                ///< s used; 0: attitude given
  double pitch_sigma = 0.0, roll_sigma = 0.0, heading_sigma = 0.0;  ///< rad
  double bias_sigma = 0.0;                                          ///< rad/s, equivalent gyro bias that remains
};

/// Levels by the mean specific force and finds north by the mean angular rate (Groves 2013 section 5.6) while the
/// odometer stands, or takes what the options give. Since the mean rate beyond the Earth's is taken off, the
/// equivalent gyro bias (Jiang eq. 6) is zero at the heading of the alignment but for noise and drift.
/// Errors: no standing start, gyros that cannot find north, a specific force that is not gravity.
[[nodiscard]] Expected<StaticStart> static_start(const sensors::ImuSeries& imu,
                                                 const Series<sensors::OdometerSample>& odometer,
                                                 const geodesy::Geodetic& place, const LandmarkOptions& options);

/// The same start with its heading turned by `heading` (rad) as the landmarks have found it, known to `sigma`. What the
/// standing gyros showed is shared out anew between Earth rate and their own bias, so that neither comes back with a
/// turn of the track.
[[nodiscard]] StaticStart with_heading(StaticStart start, double heading, double sigma);

}  // namespace versine::fusion::landmark
