// SPDX-License-Identifier: Apache-2.0
#include "versine/filter/kernels.hpp"

#include <Eigen/Cholesky>

namespace versine::filter {

template <int N, int M>
bool rts_gain(const StateMatrix<N>& P, const Transition<N, M>& phi, StateMatrix<N>& gain, StateMatrix<N>& predicted) {
  const Eigen::Index n = P.rows();
  predicted = P;
  predict<N>(predicted, phi);
  // Phi P, then solve: A' = predicted^-1 (Phi P). Scaling to unit diagonal first: metres and radians per second differ
  // by ten orders of magnitude.
  StateMatrix<N> phi_p(n, n);
  phi_p.template topRows<M>().noalias() = phi.top.lazyProduct(P);
  phi_p.bottomRows(n - M) = phi.decay.tail(n - M).asDiagonal() * P.bottomRows(n - M);
  if (!(predicted.diagonal().minCoeff() > 0.0)) return false;
  const StateVector<N> scale = predicted.diagonal().cwiseSqrt().cwiseInverse();
  StateMatrix<N> scaled = scale.asDiagonal() * predicted * scale.asDiagonal();
  Eigen::LLT<StateMatrix<N>> llt(scaled);
  if (llt.info() != Eigen::Success) {
    scaled.diagonal().array() += 1e-6;  // records are kept in float: their rounding may exceed the smallest eigenvalue
    llt.compute(scaled);
    if (llt.info() != Eigen::Success) return false;
  }
  const StateMatrix<N> right = scale.asDiagonal() * phi_p;
  const StateMatrix<N> solved = scale.asDiagonal() * llt.solve(right);
  gain = solved.transpose();
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
