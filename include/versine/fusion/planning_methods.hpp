// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "versine/fusion/planning_chain.hpp"

/// Comparison of methods by covariance (Jiang 2017 figure 8): the same sensors, landmarks and speed, three estimators.
namespace versine::fusion {

enum class PlanMethod {
  ins_landmark,           ///< inertial navigation and landmarks
  ins_odometer_landmark,  ///< the aided INS: with odometer and the constraint that wheels do not move sideways
  landmark_reckoning,     ///< gyros, odometer and landmarks (this method)
};
[[nodiscard]] const char* to_string(PlanMethod method);

struct MethodAccuracy {
  PlanMethod method = PlanMethod::landmark_reckoning;
  std::vector<ProfilePoint> profile;
  Directions worst_interior;
};

/// Smoothed covariance of the method over the chained intervals. The inertial methods estimate 18 states (position,
/// velocity, attitude, both biases, odometer scale, two mounting angles) with the error dynamics of the aided INS and
/// are rid of what alignment leaves correlated: level with accelerometer bias, heading with gyro bias.
[[nodiscard]] MethodAccuracy method_accuracy(const PlanCase& plan, PlanMethod method);

}  // namespace versine::fusion
