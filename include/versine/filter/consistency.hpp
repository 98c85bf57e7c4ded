// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "versine/filter/linearized.hpp"

namespace versine::filter {

/// Quantile of chi-square: the value that a fraction `probability` stays below. REQUIRES 0 < probability < 1, dof >= 1.
[[nodiscard]] double chi_square_quantile(double probability, double dof);

/// Two-sided bounds of the mean of `count` chi-square values of `dof` degrees of freedom each (NEES or NIS), divided
/// by dof: a consistent estimator stays inside with the given probability.
struct Bounds {
  double lower = 0.0, upper = 0.0;
};
[[nodiscard]] Bounds mean_chi_square_bounds(std::size_t count, double dof, double probability = 0.95);

/// Innovation filtering (Groves 2013 section 17.3.1): thresholds of the normalised innovation squared by the number of
/// rows.
class Gate {
 public:
  /// `false_alarm`: chance that a good measurement is rejected.
  explicit Gate(double false_alarm);
  [[nodiscard]] double threshold(int rows) const { return threshold_[static_cast<std::size_t>(rows)]; }

 private:
  std::array<double, max_rows + 1> threshold_{};
};

/// Innovation sequence monitoring (Groves 2013 section 17.3.3): the mean of the last innovations, each normalised and
/// whitened, is zero with covariance I / length for a healthy sensor. Finds faults too small for a gate.
class InnovationMonitor {
 public:
  InnovationMonitor(int length, double false_alarm);
  /// Adds one whitened innovation; true when the mean of the window is now beyond its threshold. The window starts anew
  /// when the number of rows changes.
  bool add(const Eigen::Ref<const Eigen::VectorXd>& whitened);
  [[nodiscard]] double statistic() const { return statistic_; }  ///< chi-square with the number of rows

 private:
  std::size_t length_;
  Gate gate_;
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, max_rows, 1>> window_;
  std::size_t next_ = 0;
  double statistic_ = 0.0;
};

}  // namespace versine::filter
