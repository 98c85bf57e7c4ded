// SPDX-License-Identifier: Apache-2.0
#include "versine/filter/kernels.hpp"

#include <Eigen/Cholesky>

namespace versine::filter {

namespace {

/// `right` becomes A^-1 right; false when A is not positive definite. Of any size, so that it is compiled once: Eigen
/// solves systems of 25 rows no faster when it knows their number.
bool solve_positive(const Eigen::Ref<const Eigen::MatrixXd>& A, Eigen::Ref<Eigen::MatrixXd> right) {
  // Scaled to unit diagonal first: metres and radians per second differ by ten orders of magnitude.
  using Matrix = StateMatrix<Eigen::Dynamic>;
  const StateVector<Eigen::Dynamic> scale = A.diagonal().cwiseSqrt().cwiseInverse();
  Matrix scaled = scale.asDiagonal() * A * scale.asDiagonal();
  Eigen::LLT<Matrix> llt(scaled);
  if (llt.info() != Eigen::Success) {
    scaled.diagonal().array() += 1e-6;  // records are kept in float: their rounding may exceed the smallest eigenvalue
    llt.compute(scaled);
    if (llt.info() != Eigen::Success) return false;
  }
  right = scale.asDiagonal() * right;
  llt.solveInPlace(right);
  right = scale.asDiagonal() * right;
  return true;
}

}  // namespace

template <int N, int M>
bool rts_gain(const StateMatrix<N>& P, const Transition<N, M>& phi, StateMatrix<N>& gain, StateMatrix<N>& predicted) {
  const Eigen::Index n = P.rows();
  predicted = P;
  predict<N>(predicted, phi);
  // Phi P, then solve: A' = predicted^-1 (Phi P).
  StateMatrix<N> phi_p(n, n);
  phi_p.template topRows<M>().noalias() = phi.top.lazyProduct(P);
  phi_p.bottomRows(n - M) = phi.decay.tail(n - M).asDiagonal() * P.bottomRows(n - M);
  if (!(predicted.diagonal().minCoeff() > 0.0)) return false;
  if (!solve_positive(predicted, phi_p)) return false;
  gain = phi_p.transpose();
  return true;
}

VERSINE_RTS_GAIN(23, moving);
VERSINE_RTS_GAIN(25, moving);
VERSINE_RTS_GAIN(26, moving);
VERSINE_RTS_GAIN(29, moving);
VERSINE_RTS_GAIN(Eigen::Dynamic, moving);
VERSINE_RTS_GAIN(25, moving_with_path);
VERSINE_RTS_GAIN(28, moving_with_path);
VERSINE_RTS_GAIN(Eigen::Dynamic, moving_with_path);

}  // namespace versine::filter
