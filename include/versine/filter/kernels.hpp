// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "versine/filter/linearized.hpp"

/// The arithmetic of a Kalman filter whose states are some that move and many that are parameters. `N` is the number
/// of states, known to the compiler for the common layouts, `Eigen::Dynamic` (up to max_states) for the others; either
/// way nothing is allocated.
namespace versine::filter {

template <int N>
inline constexpr int capacity = N == Eigen::Dynamic ? max_states : N;
template <int N>
using StateVector = Eigen::Matrix<double, N, 1, Eigen::ColMajor, capacity<N>, 1>;
template <int N>
using StateMatrix = Eigen::Matrix<double, N, N, Eigen::ColMajor, capacity<N>, capacity<N>>;

inline constexpr int moving = 10;            ///< states that move: position, velocity, attitude, odometer distance
inline constexpr int moving_with_path = 12;  ///< and the wheels' ways to the right and down

/// A transition: the first M rows are full, a parameter only decays (1: constant). White noise of the variances
/// `noise` acts half before and half after it (trapezoidal rule).
template <int N, int M = moving>
struct Transition {
  Eigen::Matrix<double, M, N, Eigen::ColMajor, M, capacity<N>> top;
  StateVector<N> decay;  ///< entries of the moving states are not used
  StateVector<N> noise;

  /// The whole transition.
  [[nodiscard]] StateMatrix<N> matrix() const {
    StateMatrix<N> m = StateMatrix<N>::Zero(decay.size(), decay.size());
    m.diagonal() = decay;
    m.template topRows<M>() = top;
    return m;
  }
};

/// P after the transition; symmetric.
template <int N, int M>
void predict(StateMatrix<N>& P, const Transition<N, M>& phi) {
  const Eigen::Index n = P.rows();
  P.diagonal() += 0.5 * phi.noise;
  Eigen::Matrix<double, M, N, Eigen::ColMajor, M, capacity<N>> rows(M, n);
  // Column by column: a sum of scaled columns of `top` keeps everything in registers.
  using Column = Eigen::Matrix<double, M, 1>;
  for (Eigen::Index j = 0; j < n; ++j) {
    Column sum = phi.top.col(0) * P(0, j);
    for (Eigen::Index k = 1; k < n; ++k) sum += phi.top.col(k) * P(k, j);
    rows.col(j) = sum;
  }
  Eigen::Matrix<double, M, M> corner;
  for (Eigen::Index j = 0; j < M; ++j) {
    Column sum = rows.col(0) * phi.top(j, 0);
    for (Eigen::Index k = 1; k < n; ++k) sum += rows.col(k) * phi.top(j, k);
    corner.col(j) = sum;
  }
  for (Eigen::Index j = M; j < n; ++j) {
    P.col(j).template head<M>() = rows.col(j) * phi.decay[j];
    P.col(j).tail(n - M) = (phi.decay[j] * P.col(j).tail(n - M)).cwiseProduct(phi.decay.tail(n - M));
    P.row(j).template head<M>() = P.col(j).template head<M>().transpose();
  }
  P.template topLeftCorner<M, M>() = 0.5 * (corner + corner.transpose());
  P.diagonal() += 0.5 * phi.noise;
}

/// One uncorrelated row of a measurement as the filter processed it: all that a smoother needs.
template <int N>
struct UpdateRow {
  double innovation = 0.0;
  double variance = 1.0;  ///< of the innovation
  StateVector<N> h, gain;
};

/// Processes one row: Joseph's form (I - k h') P (I - k h')' + k r k' in O(n^2). Returns gain and innovation and moves
/// the error estimate `x`. P is symmetric up to rounding: see `symmetrize`.
template <int N>
UpdateRow<N> update_row(StateVector<N>& x, StateMatrix<N>& P, const StateVector<N>& h, double z, double r) {
  UpdateRow<N> row;
  row.h = h;
  StateVector<N> a(P.rows());
  a.noalias() = P.lazyProduct(h);
  row.variance = h.dot(a) + r;
  row.gain = a / row.variance;
  row.innovation = z - h.dot(x);
  x += row.gain * row.innovation;
  P.noalias() -= row.gain.lazyProduct(a.transpose());
  a.noalias() = P.lazyProduct(h);
  const StateVector<N> correction = r * row.gain - a;
  P.noalias() += correction.lazyProduct(row.gain.transpose());
  return row;
}

/// Makes P exactly symmetric; after the rows of a measurement.
template <int N>
void symmetrize(StateMatrix<N>& P) {
  for (Eigen::Index j = 1; j < P.cols(); ++j) {
    for (Eigen::Index i = 0; i < j; ++i) P(i, j) = P(j, i) = 0.5 * (P(i, j) + P(j, i));
  }
}

/// Adjoint state of the modified Bryson-Frazier smoother (Bierman 1973): the smoothed estimate is `x - P lambda`, its
/// covariance `P - P Lambda P`, with x and P of the filter at the same moment.
template <int N>
struct Adjoint {
  StateVector<N> lambda;
  StateMatrix<N> Lambda;
  explicit Adjoint(Eigen::Index n) : lambda(n), Lambda(n, n) {
    lambda.setZero();
    Lambda.setZero();
  }
};

/// From after a row to before it.
template <int N>
void undo_row(Adjoint<N>& a, const StateVector<N>& h, const StateVector<N>& gain, double innovation, double variance) {
  a.lambda -= h * (gain.dot(a.lambda) + innovation / variance);
  StateVector<N> w(h.size());
  w.noalias() = a.Lambda.lazyProduct(gain);
  const StateVector<N> u = 0.5 * (gain.dot(w) + 1.0 / variance) * h - w;
  a.Lambda.noalias() += u.lazyProduct(h.transpose());
  a.Lambda.noalias() += h.lazyProduct(u.transpose());
}

/// From after a transition to before it.
template <int N, int M>
void undo_transition(Adjoint<N>& a, const Transition<N, M>& phi) {
  const Eigen::Index n = a.lambda.size(), m = n - M;
  const auto decay = phi.decay.tail(m);
  StateVector<N> lambda(n);
  lambda.noalias() = phi.top.transpose().lazyProduct(a.lambda.template head<M>());
  lambda.tail(m) += decay.cwiseProduct(a.lambda.tail(m));
  a.lambda = lambda;

  // Lambda' = T' L_tt T + T' L_tp D + D L_pt T + D L_pp D, with T the full rows and D the decays.
  Eigen::Matrix<double, M, N, Eigen::ColMajor, M, capacity<N>> w(M, n);
  w.noalias() = (0.5 * a.Lambda.template topLeftCorner<M, M>()).eval().lazyProduct(phi.top);
  w.rightCols(m) += a.Lambda.topRightCorner(M, m) * decay.asDiagonal();
  StateMatrix<N> half(n, n);
  half.noalias() = phi.top.transpose().lazyProduct(w);
  StateMatrix<N> next = half + half.transpose();
  for (Eigen::Index j = 0; j < m; ++j) {
    next.col(M + j).tail(m) += decay[j] * decay.cwiseProduct(a.Lambda.col(M + j).tail(m));
  }
  a.Lambda = next;
}

/// Gain A of the Rauch-Tung-Striebel smoother over one transition, `P Phi' (P predicted)^-1` (Chen 2018 eq. 13), from
/// the filter's P before it. Returns also the predicted covariance. False when that is not positive definite.
template <int N, int M>
bool rts_gain(const StateMatrix<N>& P, const Transition<N, M>& phi, StateMatrix<N>& gain, StateMatrix<N>& predicted);

#define VERSINE_RTS_GAIN(N, M) \
  template bool rts_gain<N, M>(const StateMatrix<N>&, const Transition<N, M>&, StateMatrix<N>&, StateMatrix<N>&)
extern VERSINE_RTS_GAIN(23, moving);
extern VERSINE_RTS_GAIN(25, moving);
extern VERSINE_RTS_GAIN(26, moving);
extern VERSINE_RTS_GAIN(29, moving);
extern VERSINE_RTS_GAIN(Eigen::Dynamic, moving);
extern VERSINE_RTS_GAIN(25, moving_with_path);
extern VERSINE_RTS_GAIN(28, moving_with_path);
extern VERSINE_RTS_GAIN(Eigen::Dynamic, moving_with_path);

}  // namespace versine::filter
