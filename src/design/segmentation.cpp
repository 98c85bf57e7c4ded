// SPDX-License-Identifier: Apache-2.0
#include "versine/design/segmentation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace versine::design {

namespace {

constexpr std::size_t long_piece = 20;

/// Sums of values against a local index, from which least-squares fits on the orthogonal (Gram) polynomials follow.
struct Sums {
  double n = 0.0, y = 0.0, xy = 0.0, xxy = 0.0, yy = 0.0;
  void add(double value) {
    y += value;
    xy += n * value;
    xxy += n * n * value;
    yy += value * value;
    n += 1.0;
  }
  /// Residual sums of squares of degrees 0, 1, 2.
  [[nodiscard]] std::array<double, 3> residual() const {
    const double mean_x = 0.5 * (n - 1.0), q = n * n - 1.0;
    const double c1 = xy - mean_x * y;
    const double c2 = xxy - 2.0 * mean_x * xy + (mean_x * mean_x - q / 12.0) * y;
    const double s0 = std::max(yy - y * y / n, 0.0);
    const double s1 = n > 1.5 ? std::max(s0 - c1 * c1 / (n * q / 12.0), 0.0) : 0.0;
    const double s2 = n > 2.5 ? std::max(s1 - c2 * c2 / (n * q * (n * n - 4.0) / 180.0), 0.0) : 0.0;
    return {s0, s1, s2};
  }
  /// Bulge of the parabola over its chord.
  [[nodiscard]] double bulge() const {
    const double mean_x = 0.5 * (n - 1.0), q = n * n - 1.0;
    const double c2 = xxy - 2.0 * mean_x * xy + (mean_x * mean_x - q / 12.0) * y;
    return std::abs(c2 / (n * q * (n * n - 4.0) / 180.0)) * n * n / 4.0;
  }
  [[nodiscard]] double mean() const { return y / n; }
  [[nodiscard]] double slope() const { return (xy - 0.5 * (n - 1.0) * y) / (n * (n * n - 1.0) / 12.0); }
};

Sums sums_of(std::span<const double> values, std::size_t from, std::size_t to) {
  Sums s;
  for (std::size_t i = from; i < to; ++i) s.add(values[i] - values[from]);
  return s;
}

double noise_variance(std::span<const double> values, int degree) {
  constexpr std::size_t window = 15;
  std::vector<double> variance;
  for (std::size_t i = 0; i + window <= values.size(); i += window / 2) {
    const double residual = sums_of(values, i, i + window).residual()[static_cast<std::size_t>(degree) + 1];
    variance.push_back(residual / static_cast<double>(window - static_cast<std::size_t>(degree) - 2));
  }
  if (variance.empty()) return 1e-12;
  const auto middle = variance.begin() + static_cast<std::ptrdiff_t>(variance.size() / 2);
  std::nth_element(variance.begin(), middle, variance.end());
  return std::max(*middle, 1e-18);
}

}  // namespace

std::vector<Segment> segment(std::span<const double> values, int degree, double correlation, std::size_t shortest,
                             std::size_t longest) {
  const std::size_t n = values.size();
  if (n == 0) return {};
  const double variance = noise_variance(values, degree) * correlation;
  const double unit = std::log(std::max(static_cast<double>(n), 3.0));
  const auto low = static_cast<std::size_t>(degree);
  // Parameters of a stretch: its polynomial and its end.
  const double low_penalty = (degree + 2.0) * unit, high_penalty = (degree + 3.0) * unit;
  std::vector<double> best(n + 1, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> from(n + 1, 0);
  std::vector<bool> ramp(n + 1, false);
  best[0] = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(best[i])) continue;
    Sums sums;
    for (std::size_t j = i; j < std::min(n, i + longest); ++j) {
      sums.add(values[j] - values[i]);
      if (j + 1 - i < std::min(shortest, n)) continue;
      const auto residual = sums.residual();
      const double a = residual[low] / variance + low_penalty, b = residual[low + 1] / variance + high_penalty;
      if (const double cost = best[i] + std::min(a, b); cost < best[j + 1]) {
        best[j + 1] = cost;
        from[j + 1] = i;
        ramp[j + 1] = b < a;
      }
    }
  }
  std::vector<Segment> out;
  for (std::size_t end = n; end > 0; end = from[end]) {
    const Sums sums = sums_of(values, from[end], end);
    const double level = degree == 0 ? values[from[end]] + sums.mean() : sums.slope();
    // The longest irregularities can bend a long straight piece significantly, yet by no more than the noise itself.
    const bool faint = degree > 0 && end - from[end] >= long_piece && sums.bulge() < 4.0 * std::sqrt(variance);
    out.push_back({from[end], end, ramp[end] && !faint, level});
  }
  std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace versine::design
