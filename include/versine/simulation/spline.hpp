// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace versine::simulation {

/// Weights of the six coefficients around a place on a uniform grid, for a value and its derivatives against the
/// grid step.
struct QuinticWeights {
  std::array<double, 6> value, first, second;
};
[[nodiscard]] QuinticWeights quintic_weights(double fraction);
/// Turns samples (`stride` apart, `count` of them) into the coefficients of the quintic B-spline through them, in
/// place (Unser 1993, two recursive poles). Near both ends, within 40 samples, the curve depends on how the samples
/// are mirrored there: give that many more than are used.
void quintic_prefilter(double* samples, std::size_t count, std::size_t stride);

/// N scalar functions of one variable on a uniform grid, interpolated four times continuously differentiable, so that
/// positions, rates and accelerations taken from it belong to one motion exactly. Built once, evaluated in constant
/// time, immutable.
template <int N>
class UniformSpline {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Samples = Eigen::Matrix<double, N, Eigen::Dynamic>;
  struct Jet {
    Vector value, first, second;  ///< against the variable
  };
  /// Samples that should stand beyond both ends of the range of use.
  static constexpr std::size_t margin = 40;

  UniformSpline() = default;
  /// Column i of `samples` is the value at begin + i * step. REQUIRES step > 0 and at least 6 columns.
  UniformSpline(double begin, double step, Samples samples)
      : begin_(begin), step_(step), coefficients_(std::move(samples)) {
    for (int row = 0; row < N; ++row) {
      quintic_prefilter(coefficients_.data() + row, static_cast<std::size_t>(coefficients_.cols()), N);
    }
  }
  /// Takes the columns as the coefficients themselves: a curve that smooths the samples (by a kernel of standard
  /// deviation step / sqrt(2)) instead of passing through them.
  static UniformSpline smoothing(double begin, double step, Samples samples) {
    UniformSpline s;
    s.begin_ = begin;
    s.step_ = step;
    s.coefficients_ = std::move(samples);
    return s;
  }

  [[nodiscard]] double begin() const { return begin_; }
  [[nodiscard]] double end() const { return begin_ + step_ * static_cast<double>(coefficients_.cols() - 1); }

  [[nodiscard]] Vector value(double x) const {
    const auto [i, u] = locate(x);
    return blend(i, quintic_weights(u).value);
  }
  [[nodiscard]] Jet jet(double x) const {
    const auto [i, u] = locate(x);
    const QuinticWeights w = quintic_weights(u);
    return {blend(i, w.value), blend(i, w.first) / step_, blend(i, w.second) / (step_ * step_)};
  }

 private:
  struct Place {
    Eigen::Index i;
    double fraction;
  };
  [[nodiscard]] Place locate(double x) const {
    const double t = (x - begin_) / step_;
    const auto i = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::floor(t)), 2, coefficients_.cols() - 4);
    return {i, t - static_cast<double>(i)};
  }
  [[nodiscard]] Vector blend(Eigen::Index i, const std::array<double, 6>& w) const {
    Vector sum = w[0] * coefficients_.col(i - 2);
    for (int k = 1; k < 6; ++k) sum += w[static_cast<std::size_t>(k)] * coefficients_.col(i - 2 + k);
    return sum;
  }

  double begin_ = 0.0, step_ = 1.0;
  Samples coefficients_;
};

}  // namespace versine::simulation
