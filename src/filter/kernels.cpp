// SPDX-License-Identifier: Apache-2.0
#include "versine/filter/kernels.hpp"

#include <Eigen/Cholesky>

namespace versine::filter {

template <int N>
bool rts_gain(const StateMatrix<N>& P, const Transition<N>& phi, StateMatrix<N>& gain, StateMatrix<N>& predicted) {
  const Eigen::Index n = P.rows();
  predicted = P;
  predict<N>(predicted, phi);
  // Phi P, then solve: A' = predicted^-1 (Phi P). Scaling to unit diagonal first: metres and radians per second differ
  // by ten orders of magnitude.
  StateMatrix<N> phi_p(n, n);
  phi_p.template topRows<moving>().noalias() = phi.top.lazyProduct(P);
  phi_p.bottomRows(n - moving) = phi.decay.tail(n - moving).asDiagonal() * P.bottomRows(n - moving);
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

template bool rts_gain<23>(const StateMatrix<23>&, const Transition<23>&, StateMatrix<23>&, StateMatrix<23>&);
template bool rts_gain<25>(const StateMatrix<25>&, const Transition<25>&, StateMatrix<25>&, StateMatrix<25>&);
template bool rts_gain<26>(const StateMatrix<26>&, const Transition<26>&, StateMatrix<26>&, StateMatrix<26>&);
template bool rts_gain<29>(const StateMatrix<29>&, const Transition<29>&, StateMatrix<29>&, StateMatrix<29>&);
template bool rts_gain<Eigen::Dynamic>(const StateMatrix<Eigen::Dynamic>&, const Transition<Eigen::Dynamic>&,
                                       StateMatrix<Eigen::Dynamic>&, StateMatrix<Eigen::Dynamic>&);

}  // namespace versine::filter
