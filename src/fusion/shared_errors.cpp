// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/shared_errors.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace versine::fusion {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Correlations closer to one would take a landmark's noise of its own for nothing, smaller ones mean nothing.
constexpr double largest_correlation = 1.0 - 1e-6, least_correlation = 1e-3;

/// The covariance's Cholesky factor in its first `rows`; a variance of nothing is made a millionth of its scale.
Matrix6 root_of(const Matrix6& covariance, int rows) {
  Eigen::MatrixXd part = covariance.topLeftCorner(rows, rows);
  const Eigen::VectorXd scale = part.diagonal().cwiseMax(1e-24).cwiseSqrt();
  part = (scale.cwiseInverse().asDiagonal() * part * scale.cwiseInverse().asDiagonal()).eval();
  part.diagonal().array() += 1e-9;
  Matrix6 root = Matrix6::Zero();
  root.topLeftCorner(rows, rows) = scale.asDiagonal() * Eigen::MatrixXd(part.llt().matrixL());
  return root;
}

}  // namespace

Matrix6 shared_covariance(std::span<const ErrorCause> a, std::span<const ErrorCause> b) {
  Matrix6 sum = Matrix6::Zero();
  for (const ErrorCause& x : a) {
    const auto y = std::find_if(b.begin(), b.end(), [&](const ErrorCause& c) { return c.name == x.name; });
    if (y != b.end()) sum += x.effect * y->effect.transpose();
  }
  return sum;
}

std::vector<std::optional<sensors::SharedError>> share_errors(std::span<const std::vector<ErrorCause>> causes,
                                                              int rows) {
  std::vector<std::optional<sensors::SharedError>> out(causes.size());
  std::size_t before = causes.size();  // the last one with causes
  for (std::size_t k = 0; k < causes.size(); ++k) {
    if (causes[k].empty()) continue;
    sensors::SharedError& s = out[k].emplace();
    s.root = root_of(shared_covariance(causes[k], causes[k]), rows);
    if (before < causes.size()) {
      const sensors::SharedError& last = *out[before];
      const auto corner = [rows](const Matrix6& m) { return m.topLeftCorner(rows, rows); };
      // In unit variances: root_k^-1 C root_last^-T.
      const Eigen::MatrixXd cross = corner(s.root).triangularView<Eigen::Lower>().solve(
          Eigen::MatrixXd(corner(shared_covariance(causes[k], causes[before]))));
      const Eigen::MatrixXd common =
          corner(last.root).triangularView<Eigen::Lower>().solve(cross.transpose()).transpose();
      s.place = last.place;
      s.place.head(rows) -=
          common.diagonal().cwiseMax(least_correlation).cwiseMin(largest_correlation).array().log().matrix();
    }
    before = k;
  }
  return out;
}

}  // namespace versine::fusion
