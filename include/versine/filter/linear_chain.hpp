// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

/// Filter and fixed-interval smoothers for a linear chain of small states (2 to 6) whose size is known to the compiler:
/// the channels of landmark dead reckoning, and covariance analysis. Two smoothers that agree: Rauch-Tung-Striebel
/// (Jiang 2017 eq. 28) and the two-filter smoother (eq. 27) with its backward filter in information form.
namespace versine::filter {

template <int N>
struct Estimate {
  Eigen::Matrix<double, N, 1> mean = Eigen::Matrix<double, N, 1>::Zero();
  Eigen::Matrix<double, N, N> covariance = Eigen::Matrix<double, N, N>::Zero();
};

/// z = H x + noise of covariance R.
template <int N, int M>
struct LinearObservation {
  Eigen::Matrix<double, M, 1> z = Eigen::Matrix<double, M, 1>::Zero();
  Eigen::Matrix<double, M, N> H = Eigen::Matrix<double, M, N>::Zero();
  Eigen::Matrix<double, M, M> R = Eigen::Matrix<double, M, M>::Zero();
};

/// x_k = transition x_{k-1} + noise of covariance `noise`, then what is observed at epoch k.
/// Step 0 leads from the initial estimate to epoch 0.
template <int N, int M>
struct LinearStep {
  Eigen::Matrix<double, N, N> transition = Eigen::Matrix<double, N, N>::Identity();
  Eigen::Matrix<double, N, N> noise = Eigen::Matrix<double, N, N>::Zero();
  std::optional<LinearObservation<N, M>> observation;
};

template <int N, int M>
struct ForwardEpoch {
  Estimate<N> predicted, updated;
};

/// Smoothed epoch; `gain` is A_k of e_k = A_k e_{k+1} + w_k (error_chain.hpp), zero at the last epoch.
template <int N>
struct SmoothedEpoch {
  Estimate<N> estimate;
  Eigen::Matrix<double, N, N> gain = Eigen::Matrix<double, N, N>::Zero();
};

template <int N, int M>
[[nodiscard]] Estimate<N> predict(const Estimate<N>& x, const LinearStep<N, M>& step) {
  Estimate<N> p;
  p.mean.noalias() = step.transition * x.mean;
  const Eigen::Matrix<double, N, N> FP = step.transition * x.covariance;
  p.covariance = FP * step.transition.transpose() + step.noise;
  p.covariance = (0.5 * (p.covariance + p.covariance.transpose())).eval();
  return p;
}

/// Kalman update in Joseph's form, which stays positive when the prior is 10 m and the measurement 0.6 mm.
template <int N, int M>
[[nodiscard]] Estimate<N> update(const Estimate<N>& x, const LinearObservation<N, M>& o) {
  const Eigen::Matrix<double, N, M> PHt = x.covariance * o.H.transpose();
  const Eigen::Matrix<double, M, M> S = o.H * PHt + o.R;
  const Eigen::Matrix<double, N, M> K = S.llt().solve(PHt.transpose()).transpose();
  const Eigen::Matrix<double, N, N> L = Eigen::Matrix<double, N, N>::Identity() - K * o.H;
  Estimate<N> u;
  u.mean = x.mean + K * (o.z - o.H * x.mean);
  u.covariance = L * x.covariance * L.transpose() + K * o.R * K.transpose();
  u.covariance = (0.5 * (u.covariance + u.covariance.transpose())).eval();
  return u;
}

template <int N, int M>
[[nodiscard]] std::vector<ForwardEpoch<N, M>> filter_forward(const Estimate<N>& initial,
                                                             std::span<const LinearStep<N, M>> steps) {
  std::vector<ForwardEpoch<N, M>> epochs(steps.size());
  const Estimate<N>* last = &initial;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    epochs[k].predicted = predict(*last, steps[k]);
    epochs[k].updated = steps[k].observation ? update(epochs[k].predicted, *steps[k].observation) : epochs[k].predicted;
    last = &epochs[k].updated;
  }
  return epochs;
}

/// Rauch-Tung-Striebel, Jiang eq. 28. REQUIRES positive definite predicted covariances and `steps` as in the filter.
template <int N, int M>
[[nodiscard]] std::vector<SmoothedEpoch<N>> smooth_rts(std::span<const LinearStep<N, M>> steps,
                                                       std::span<const ForwardEpoch<N, M>> forward) {
  std::vector<SmoothedEpoch<N>> smoothed(forward.size());
  if (forward.empty()) return smoothed;
  smoothed.back().estimate = forward.back().updated;
  for (std::size_t k = forward.size() - 1; k-- > 0;) {
    const Estimate<N>& filtered = forward[k].updated;
    const Estimate<N>& predicted = forward[k + 1].predicted;
    const Estimate<N>& next = smoothed[k + 1].estimate;
    const Eigen::LLT<Eigen::Matrix<double, N, N>> llt(predicted.covariance);
    if (llt.info() != Eigen::Success) throw std::domain_error("smooth_rts: predicted covariance not positive definite");
    auto& [estimate, gain] = smoothed[k];
    gain = llt.solve(steps[k + 1].transition * filtered.covariance).transpose();
    estimate.mean = filtered.mean + gain * (next.mean - predicted.mean);
    // P_f = A P_p A' + W with W >= 0, so P_s = W + A P_s' A' is a sum of positive terms (no cancellation).
    const Eigen::Matrix<double, N, N> L = Eigen::Matrix<double, N, N>::Identity() - gain * steps[k + 1].transition;
    const Eigen::Matrix<double, N, N> P =
        L * filtered.covariance * L.transpose() + gain * (steps[k + 1].noise + next.covariance) * gain.transpose();
    estimate.covariance = 0.5 * (P + P.transpose());
  }
  return smoothed;
}

/// What the measurements behind an epoch say about it: information matrix and vector. It starts at zero (nothing is
/// known beyond the end), so no covariance of the backward filter need exist.
template <int N>
struct Information {
  Eigen::Matrix<double, N, N> matrix = Eigen::Matrix<double, N, N>::Zero();
  Eigen::Matrix<double, N, 1> vector = Eigen::Matrix<double, N, 1>::Zero();

  template <int M>
  void add(const LinearObservation<N, M>& o) {
    const Eigen::Matrix<double, M, N> RinvH = o.R.llt().solve(o.H);
    matrix += o.H.transpose() * RinvH;
    vector += RinvH.transpose() * o.z;
  }
  /// Backwards over a step: Y = F' (I + Y Q)^-1 Y F, which needs neither Q^-1 nor Y^-1 (both are singular here).
  template <int M>
  void propagate_back(const LinearStep<N, M>& step) {
    const Eigen::Matrix<double, N, N> T = Eigen::Matrix<double, N, N>::Identity() + matrix * step.noise;
    const Eigen::PartialPivLU<Eigen::Matrix<double, N, N>> lu(T);
    const Eigen::Matrix<double, N, N> Y = step.transition.transpose() * lu.solve(matrix) * step.transition;
    vector = (step.transition.transpose() * lu.solve(vector)).eval();
    matrix = 0.5 * (Y + Y.transpose());
  }
  /// Combines with an independent estimate (Jiang eq. 27): P = (P_f^-1 + Y)^-1 = (I + P_f Y)^-1 P_f.
  [[nodiscard]] Estimate<N> combined_with(const Estimate<N>& f) const {
    const Eigen::Matrix<double, N, 1> d = f.covariance.diagonal().cwiseSqrt();  // balances metres and radians
    const Eigen::Matrix<double, N, 1> i = d.cwiseInverse();
    const Eigen::Matrix<double, N, N> P = i.asDiagonal() * f.covariance * i.asDiagonal();
    const Eigen::Matrix<double, N, N> T =
        Eigen::Matrix<double, N, N>::Identity() + P * (d.asDiagonal() * matrix * d.asDiagonal());
    const Eigen::PartialPivLU<Eigen::Matrix<double, N, N>> lu(T);
    Estimate<N> s;
    s.mean = d.asDiagonal() * lu.solve(i.asDiagonal() * f.mean + P * (d.asDiagonal() * vector));
    const Eigen::Matrix<double, N, N> C = d.asDiagonal() * lu.solve(P) * d.asDiagonal();
    s.covariance = 0.5 * (C + C.transpose());
    return s;
  }
};

/// Two-filter smoother, Jiang eq. 27. The gains are those of RTS, which are the chain's own whatever the smoother.
template <int N, int M>
[[nodiscard]] std::vector<SmoothedEpoch<N>> smooth_two_filter(std::span<const LinearStep<N, M>> steps,
                                                              std::span<const ForwardEpoch<N, M>> forward) {
  std::vector<SmoothedEpoch<N>> smoothed(forward.size());
  Information<N> behind;
  for (std::size_t k = forward.size(); k-- > 0;) {
    smoothed[k].estimate = behind.combined_with(forward[k].updated);
    if (k + 1 < forward.size()) {
      smoothed[k].gain = forward[k + 1]
                             .predicted.covariance.llt()
                             .solve(steps[k + 1].transition * forward[k].updated.covariance)
                             .transpose();
    }
    if (steps[k].observation) behind.add(*steps[k].observation);
    behind.propagate_back(steps[k]);
  }
  return smoothed;
}

}  // namespace versine::filter
