// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

namespace versine::filter {

inline constexpr int max_states = 40;
inline constexpr int max_rows = 6;

/// A measurement seen from a filter: `z = H x + n`, cov(n) = R, with x the error state. For the aided INS z is
/// *predicted minus measured* (Chen 2018 eq. 8, 12). A measurement model returns one and never sees the filter.
struct Linearized {
  Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, max_rows, 1> z;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, max_rows, max_states> H;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_rows, max_rows> R;

  Linearized() = default;
  Linearized(int rows, int states) : z(rows), H(rows, states), R(rows, rows) {
    z.setZero();
    H.setZero();
    R.setZero();
  }
  [[nodiscard]] int rows() const { return static_cast<int>(z.size()); }
};

/// Makes the rows uncorrelated and of unit variance, by the Cholesky factor of R; R is left as it is. False when R is
/// not positive definite: the measurement is then of no use.
[[nodiscard]] bool whiten(Linearized& l);

}  // namespace versine::filter
