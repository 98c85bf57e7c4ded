// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "versine/core/run_record.hpp"
#include "versine/filter/error_chain.hpp"
#include "versine/geodesy/trajectory.hpp"

namespace versine::fusion {

/// A measurement as the filter saw it.
struct Innovation {
  Time time;
  std::string sensor;     ///< "gnss position", "odometer", "constraint", "zero velocity", "landmark", ...
  Eigen::VectorXf value;  ///< measured minus predicted, in the unit of the measurement
  Eigen::VectorXf sigma;  ///< square roots of the diagonal of its covariance
  double nis = 0.0;       ///< normalised innovation squared; chi-square with value.size() degrees of freedom
  bool used = true;
};

/// Estimated sensor errors at one time, with their standard deviations. `value` and `sigma` follow `names` of the
/// solution: "gyro_bias_x", ..., "odometer_scale", "mounting_pitch", ...; SI and radians.
struct SensorErrorSample {
  Time time;
  Eigen::VectorXf value;
  Eigen::VectorXf sigma;
};

/// What every navigation method returns: aided INS and landmark dead reckoning alike, so that everything downstream
/// works on either.
struct Solution {
  geodesy::Trajectory smoothed;
  geodesy::Trajectory forward;  ///< empty unless asked for
  std::vector<std::string> error_names;
  std::vector<SensorErrorSample> sensor_errors;  ///< smoothed
  filter::ErrorChain chain;                      ///< at a lower rate than the trajectory; empty unless asked for
  std::vector<Innovation> innovations;
  RunRecord record;
};

}  // namespace versine::fusion
