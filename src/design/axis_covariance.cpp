// SPDX-License-Identifier: Apache-2.0
#include "axis_covariance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace versine::design {

namespace {
constexpr double correlation_range = 400.0;  // m; residuals further apart count as independent

double parzen(double x) {
  return x < 0.5 ? 1.0 - 6.0 * x * x * (1.0 - x) : 2.0 * (1.0 - x) * (1.0 - x) * (1.0 - x);
}
}  // namespace

Eigen::MatrixXd covariance_of_fit(const Eigen::MatrixXd& j, const Eigen::VectorXd& r, int rows, double step) {
  const Eigen::Index n = r.size() / rows, unknowns = j.cols();
  const auto lags = std::min<Eigen::Index>(n / 4, static_cast<Eigen::Index>(std::ceil(correlation_range / step)));
  std::vector<Eigen::MatrixXd> gamma(static_cast<std::size_t>(lags) + 1, Eigen::MatrixXd::Zero(rows, rows));
  const double freedom = std::max(1.0, static_cast<double>(n) - static_cast<double>(unknowns) / rows);
  for (Eigen::Index k = 0; k <= lags; ++k) {
    auto& g = gamma[static_cast<std::size_t>(k)];
    for (Eigen::Index i = 0; i + k < n; ++i)
      g += r.segment(rows * i, rows) * r.segment(rows * (i + k), rows).transpose();
    g *= parzen(static_cast<double>(k) / (static_cast<double>(lags) + 1.0)) / freedom;
  }
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(unknowns, unknowns), carried(rows, unknowns);
  for (Eigen::Index i = 0; i < n; ++i) {
    carried.noalias() = gamma[0] * j.middleRows(rows * i, rows);
    for (Eigen::Index k = 1; k <= lags; ++k) {
      const auto& g = gamma[static_cast<std::size_t>(k)];
      if (i + k < n) carried.noalias() += g * j.middleRows(rows * (i + k), rows);
      if (i - k >= 0) carried.noalias() += g.transpose() * j.middleRows(rows * (i - k), rows);
    }
    meat.noalias() += j.middleRows(rows * i, rows).transpose() * carried;
  }
  // Unknowns have very different sizes: scale before inverting.
  const Eigen::VectorXd scale = (j.colwise().norm().transpose().array() + 1e-300).inverse();
  const Eigen::MatrixXd scaled = j * scale.asDiagonal();
  const Eigen::MatrixXd bread =
      (scaled.transpose() * scaled).ldlt().solve(Eigen::MatrixXd::Identity(unknowns, unknowns));
  const Eigen::MatrixXd inverse = scale.asDiagonal() * bread * scale.asDiagonal();
  return inverse * meat * inverse;
}

}  // namespace versine::design
