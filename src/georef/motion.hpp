// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "versine/georef/options.hpp"

namespace versine::georef {

/// Discrete motion over n grid steps: (d, s, a), and the correlated GNSS error's decay.
struct Motion {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity(), Q = Eigen::Matrix3d::Zero();
  double decay = 1.0;
};

/// Composes one grid step n times; remembers what it made, since the same few n come again and again.
class MotionTable {
 public:
  MotionTable(const MotionModel& model, double grid, double correlation_time);
  [[nodiscard]] const Motion& steps(std::int64_t n);

 private:
  std::vector<Motion> table_;
};

}  // namespace versine::georef
