// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>

#include "steps.hpp"

namespace versine::fusion::detail {

/// Smoothed errors at one step's end, relative to the forward estimate there.
template <int N>
struct SmoothedStep {
  filter::StateVector<N> x;                ///< after the step's updates
  filter::StateVector<N> before;           ///< the same error relative to the estimate before the updates
  Eigen::Matrix<double, 9, 9> navigation;  ///< covariance of position, velocity, attitude (blocks on the diagonal only)
  filter::StateVector<N> variance;         ///< of all states; size 0 unless asked for
};

/// What is wanted at a step beside position, velocity and attitude.
struct Wanted {
  bool variances = false;  ///< of all states
  bool chain = false;      ///< full covariance and gain to the chain epoch after it
};

/// Sum of the step's corrections: what its updates took off the estimate.
template <int N>
filter::StateVector<N> corrections(const Steps& s, std::size_t k, int n) {
  filter::StateVector<N> x = filter::StateVector<N>::Zero(n);
  for (std::size_t r = 0; r < s.steps[k].rows; ++r) {
    const Row& row = s.rows[s.steps[k].first_row + r];
    for (int i = 0; i < n; ++i) x[i] += double(row.gain[i]) * double(row.innovation);
  }
  return x;
}

/// The smoothers: pure functions over the steps of the forward pass. `wanted(k)` tells what is asked for at step k,
/// `take(k, smoothed)` receives each step, last first, `chain(k, covariance, gain)` each chain epoch.
template <int N, int M>
class Backward {
 public:
  using Vector = filter::StateVector<N>;
  using Matrix = filter::StateMatrix<N>;
  using Wish = std::function<Wanted(std::size_t)>;
  using Take = std::function<void(std::size_t, const SmoothedStep<N>&)>;
  using Chain = std::function<void(std::size_t, const Matrix&, const Matrix&, bool)>;

  Backward(const Steps& steps, const NoiseModel& noise, int n) : s_(steps), noise_(noise), n_(n) {}

  /// Modified Bryson-Frazier as long as its difference P - P Lambda P keeps its digits, which it does not where the
  /// measurements to come know a thousand times better than those before (the very start of a run): there
  /// Rauch-Tung-Striebel takes over, whose sum of positive terms does. Returns the number of steps it took; nothing
  /// when a covariance was not positive definite.
  std::optional<std::size_t> bryson_frazier(const Wish& wanted, const Take& take, const Chain& chain) {
    filter::Adjoint<N> a(n_), next(n_);
    Matrix P(n_, n_), full(n_, n_);
    Gains gains(*this, chain);
    SmoothedStep<N> out;
    for (std::size_t k = s_.steps.size(); k-- > 0;) {
      const Wanted w = wanted(k);
      unpack<N>(s_.steps[k], P);
      SmoothedStep<N> here;
      here.x = -(P.lazyProduct(a.lambda));
      here.before = here.x + corrections<N>(s_, k, n_);
      if (!reduce(P, a.Lambda, w, here, full)) {
        if (k + 1 < s_.steps.size()) {
          unpack<N>(s_.steps[k + 1], P);
          full = P - P * next.Lambda * P;
        }
        return rauch_tung_striebel(k + 1, full, out.before, gains, wanted, take);
      }
      out = here;
      if (!gains.at(k, P, full, w)) return std::nullopt;
      take(k, out);
      next = a;
      if (k > 0) undo_step(k, a);
    }
    return 0;
  }

  std::optional<std::size_t> rauch_tung_striebel(const Wish& wanted, const Take& take, const Chain& chain) {
    Gains gains(*this, chain);
    return rauch_tung_striebel(s_.steps.size(), Matrix(n_, n_), Vector(n_), gains, wanted, take);
  }

 private:
  /// Products of gains between chain epochs.
  class Gains {
   public:
    Gains(const Backward& b, const Chain& chain) : b_(b), chain_(chain) {}
    bool at(std::size_t k, const Matrix& P, const Matrix& smoothed, const Wanted& w) {
      if (!chain_) return true;
      if (k + 1 < b_.s_.steps.size()) {
        Matrix gain(b_.n_, b_.n_), predicted(b_.n_, b_.n_);
        filter::Transition<N, M> phi;
        unpack_transition(b_.s_.steps[k + 1], b_.noise_, phi, b_.n_);
        if (!filter::rts_gain(P, phi, gain, predicted)) return false;
        product_ = started_ ? Matrix(gain * product_) : gain;
      }
      if (w.chain) {
        chain_(k, smoothed, product_, started_);
        started_ = true;
        product_ = Matrix::Identity(b_.n_, b_.n_);
      }
      return true;
    }

   private:
    const Backward& b_;
    const Chain& chain_;
    Matrix product_;
    bool started_ = false;
  };

  /// From step `end` - 1 to the start, given the smoothed covariance and error (before its updates) of step `end`.
  std::optional<std::size_t> rauch_tung_striebel(std::size_t end, Matrix smoothed, Vector before, Gains& gains,
                                                 const Wish& wanted, const Take& take) {
    Matrix P(n_, n_), gain(n_, n_), predicted(n_, n_), rest(n_, n_), noise(n_, n_);
    SmoothedStep<N> out;
    filter::Transition<N, M> phi;
    for (std::size_t k = end; k-- > 0;) {
      unpack<N>(s_.steps[k], P);
      if (k + 1 == s_.steps.size()) {
        out.x = Vector::Zero(n_);
        smoothed = P;
      } else {
        unpack_transition(s_.steps[k + 1], noise_, phi, n_);
        if (!filter::rts_gain(P, phi, gain, predicted)) return std::nullopt;
        out.x = (gain * before).eval();
        // (I - A Phi) P (I - A Phi)' + A (Q + S) A', with half of the noise before Phi and half after it.
        const Matrix transition = phi.matrix();
        rest = Matrix::Identity(n_, n_) - gain * transition;
        noise = smoothed;
        noise.diagonal() += 0.5 * phi.noise;
        const Matrix early = gain * transition;
        smoothed = rest * P * rest.transpose() + gain * noise * gain.transpose() +
                   early * (0.5 * phi.noise).asDiagonal() * early.transpose();
        smoothed = (0.5 * (smoothed + smoothed.transpose())).eval();
      }
      out.before = before = out.x + corrections<N>(s_, k, n_);
      if (!(smoothed.diagonal().minCoeff() > 0.0)) return std::nullopt;
      out.navigation = smoothed.template topLeftCorner<9, 9>();
      out.variance = smoothed.diagonal();
      if (!gains.at(k, P, smoothed, wanted(k))) return std::nullopt;
      take(k, out);
    }
    return end;
  }

  /// P - P Lambda P, as much of it as is wanted. False when the difference has lost its digits: P is kept in float.
  bool reduce(const Matrix& P, const Matrix& Lambda, const Wanted& w, SmoothedStep<N>& out, Matrix& full) {
    if (w.variances || w.chain) {
      Matrix t(n_, n_);
      t.noalias() = P * Lambda;
      full = P;
      full.noalias() -= t * P;
      full = (0.5 * (full + full.transpose())).eval();
      out.navigation = full.template topLeftCorner<9, 9>();
      out.variance = full.diagonal();
      return (full.diagonal() - least * P.diagonal()).minCoeff() > 0.0;
    }
    out.variance.resize(N == Eigen::Dynamic ? 0 : n_);
    Eigen::Matrix<double, 9, N, Eigen::ColMajor, 9, filter::capacity<N>> t(9, n_);
    t.noalias() = P.template topRows<9>().lazyProduct(Lambda);
    for (int b = 0; b < 9; b += 3) {
      out.navigation.template block<3, 3>(b, b) =
          P.template block<3, 3>(b, b) - t.template middleRows<3>(b).lazyProduct(P.template middleCols<3>(b));
    }
    return (out.navigation.diagonal() - least * P.diagonal().template head<9>()).minCoeff() > 0.0;
  }

  void undo_step(std::size_t k, filter::Adjoint<N>& a) {
    const Step& step = s_.steps[k];
    Vector h(n_), gain(n_);
    for (std::size_t r = step.rows; r-- > 0;) {
      const Row& row = s_.rows[step.first_row + r];
      for (int i = 0; i < n_; ++i) {
        h[i] = double(row.h[i]);
        gain[i] = double(row.gain[i]);
      }
      filter::undo_row<N>(a, h, gain, double(row.innovation), double(row.variance));
    }
    filter::Transition<N, M> phi;
    unpack_transition(step, noise_, phi, n_);
    filter::undo_transition(a, phi);
  }

  static constexpr double least = 1e-5;  ///< of the filter's variance that may be left: two digits of a float
  const Steps& s_;
  const NoiseModel& noise_;
  int n_;
};

}  // namespace versine::fusion::detail
