// SPDX-License-Identifier: Apache-2.0
#include "versine/track/resampling.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "versine/core/numbers.hpp"

namespace versine::track {
namespace {

/// Index of the last sample at or before x, kept by a caller that asks in increasing order.
std::size_t advance(std::span<const double> s, std::size_t i, double x) {
  while (i + 1 < s.size() && s[i + 1] <= x) ++i;
  return i;
}

bool covered(std::span<const double> s, std::size_t i, double x, double max_gap) {
  if (s.empty() || x < s[i] || i + 1 > s.size()) return false;
  if (i + 1 == s.size()) return x <= s[i];
  return s[i + 1] - s[i] <= max_gap || x == s[i];
}

double tricube(double t) {
  const double a = 1.0 - std::abs(t * t * t);
  return a > 0.0 ? a * a * a : 0.0;
}

double at_line(std::span<const double> s, std::span<const double> x, std::size_t i, double at) {
  if (i + 1 >= s.size()) return x[i];
  return x[i] + (x[i + 1] - x[i]) * (at - s[i]) / (s[i + 1] - s[i]);
}

/// Integral of the broken line from a to b, both within its pieces from sample i on, without crossing gaps.
double integral(std::span<const double> s, std::span<const double> x, std::size_t i, double a, double b) {
  double sum = 0.0;
  double from = a, value = at_line(s, x, i, a);
  while (from < b) {
    while (i + 1 < s.size() && s[i + 1] <= from) ++i;
    const double to = i + 1 < s.size() ? std::min(b, s[i + 1]) : b;
    const double next = at_line(s, x, i, to);
    sum += 0.5 * (value + next) * (to - from);
    from = to;
    value = next;
  }
  return sum;
}

struct Stretch {
  std::size_t first, last;  // last is exclusive
  double half_width;
};

/// Samples strictly within the half width, at least four of them within a stretch without gaps.
Stretch window_around(std::span<const double> s, std::size_t i, double x, double half_width, double max_gap) {
  std::size_t a = i, b = i + 1;
  double h = half_width;
  while (a > 0 && x - s[a - 1] < h && s[a] - s[a - 1] <= max_gap) --a;
  while (b < s.size() && s[b] - x < h && s[b] - s[b - 1] <= max_gap) ++b;
  if (x - s[a] >= h && a < i) ++a;
  const bool sparse = b - a < 4;
  while (b - a < 4) {
    const double left = a > 0 && s[a] - s[a - 1] <= max_gap ? x - s[a - 1] : nan;
    const double right = b < s.size() && s[b] - s[b - 1] <= max_gap ? s[b] - x : nan;
    if (std::isnan(left) && std::isnan(right)) break;
    if (std::isnan(right) || left <= right)
      --a;
    else
      ++b;
  }
  if (sparse) h = std::max(h, 1.1 * std::max(x - s[a], s[b - 1] - x));
  return {a, b, h};
}

struct Local {
  Eigen::Vector3d weights_of_value;  // first row of the inverse normal matrix
  Eigen::Vector3d a, b, c;           // value, slope, curvature terms for the three coordinates
};

Local solve(std::span<const double> s, std::span<const Eigen::Vector3d> r, const Stretch& w, double x,
            const double* weight) {
  double m[5] = {0, 0, 0, 0, 0};
  Eigen::Matrix3d rhs = Eigen::Matrix3d::Zero();
  const Eigen::Vector3d r0 = r[w.first];
  for (std::size_t k = w.first; k < w.last; ++k) {
    const double t = (s[k] - x) / w.half_width, g = weight[k - w.first], gt = g * t, gtt = gt * t;
    m[0] += g;
    m[1] += gt;
    m[2] += gtt;
    m[3] += gtt * t;
    m[4] += gtt * t * t;
    const Eigen::Vector3d d = r[k] - r0;
    rhs.row(0) += g * d.transpose();
    rhs.row(1) += gt * d.transpose();
    rhs.row(2) += gtt * d.transpose();
  }
  Eigen::Matrix3d M;
  M << m[0], m[1], m[2], m[1], m[2], m[3], m[2], m[3], m[4];
  // Three samples or fewer do not hold a parabola: a small ridge on the curvature turns it into a line there.
  M(2, 2) += 1e-9 * m[0];
  if (w.last - w.first < 3) M(2, 2) += m[0];
  if (w.last - w.first < 2) M(1, 1) += m[0];
  const Eigen::LDLT<Eigen::Matrix3d> ldlt(M);
  const Eigen::Matrix3d c = ldlt.solve(rhs);
  Local out;
  out.weights_of_value = ldlt.solve(Eigen::Vector3d::UnitX());
  out.a = c.row(0).transpose() + r0;
  out.b = c.row(1);
  out.c = c.row(2);
  return out;
}

}  // namespace

std::vector<double> moving_average(std::span<const double> s, std::span<const double> x, std::span<const double> at,
                                   double window, double max_gap) {
  std::vector<double> out(at.size(), nan);
  std::size_t i = 0;
  for (std::size_t k = 0; k < at.size(); ++k) {
    i = advance(s, i, at[k]);
    if (!covered(s, i, at[k], max_gap)) continue;
    std::size_t a = i, b = i;
    const double from = at[k] - 0.5 * window, to = at[k] + 0.5 * window;
    while (a > 0 && s[a] > from && s[a] - s[a - 1] <= max_gap) --a;
    while (b + 1 < s.size() && s[b] < to && s[b + 1] - s[b] <= max_gap) ++b;
    // Cut off on both sides alike, so that a trend is not biased at the ends of a piece.
    const double half = std::min({0.5 * window, at[k] - s[a], s[b] - at[k]});
    out[k] = half > 1e-9 ? integral(s, x, a, at[k] - half, at[k] + half) / (2.0 * half) : at_line(s, x, i, at[k]);
  }
  return out;
}

double moving_average_gain(double window, double wavelength) {
  const double u = std::numbers::pi * window / wavelength;
  return u == 0.0 ? 1.0 : std::sin(u) / u;
}

std::vector<double> median_filter(std::span<const double> s, std::span<const double> x, double window) {
  std::vector<double> out(x.begin(), x.end()), work;
  std::size_t a = 0, b = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    while (s[a] < s[k] - 0.5 * window) ++a;
    while (b < s.size() && s[b] <= s[k] + 0.5 * window) ++b;
    // Symmetric about k, so that a trend passes.
    const std::size_t half = std::min(k - a, b - 1 - k);
    work.assign(x.begin() + static_cast<std::ptrdiff_t>(k - half),
                x.begin() + static_cast<std::ptrdiff_t>(k + half + 1));
    std::nth_element(work.begin(), work.begin() + static_cast<std::ptrdiff_t>(half), work.end());
    out[k] = work[half];
  }
  return out;
}

std::vector<FitPoint> fit_moving(std::span<const double> s, std::span<const Eigen::Vector3d> r,
                                 std::span<const double> at, double half_width, double max_gap) {
  std::vector<FitPoint> out(at.size());
  std::vector<double> base, kernel, weight, residual, sorted;
  std::size_t i = 0;
  for (std::size_t k = 0; k < at.size(); ++k) {
    out[k].r.setConstant(nan);
    out[k].sigma = nan;
    i = advance(s, i, at[k]);
    if (!covered(s, i, at[k], max_gap)) continue;
    const Stretch w = window_around(s, i, at[k], half_width, max_gap);
    const std::size_t n = w.last - w.first;
    base.resize(n);
    kernel.resize(n);
    residual.resize(n);
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t q = w.first + j;
      const double before = q > w.first ? s[q] - s[q - 1] : 0.0, after = q + 1 < w.last ? s[q + 1] - s[q] : 0.0;
      const double own = n > 1 ? (before > 0.0 && after > 0.0 ? 0.5 * (before + after) : before + after) : 1.0;
      kernel[j] = tricube((s[q] - at[k]) / w.half_width);
      base[j] = kernel[j] * own;
    }
    weight = base;
    Local fit = solve(s, r, w, at[k], weight.data());
    double scale = 0.0;
    for (int pass = 0; pass < 3 && n > 5; ++pass) {
      for (std::size_t j = 0; j < n; ++j) {
        const double t = (s[w.first + j] - at[k]) / w.half_width;
        residual[j] = (r[w.first + j] - fit.a - t * (fit.b + t * fit.c)).head<2>().norm();
      }
      sorted = residual;
      const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(n / 2);
      std::nth_element(sorted.begin(), middle, sorted.end());
      scale = *middle / 1.1774;  // median of a Rayleigh distribution
      // Residuals count as their weight does: at the window's edge a parabola is allowed to be off.
      for (std::size_t j = 0; j < n; ++j) residual[j] *= std::sqrt(kernel[j]);
      const double cut = std::max(6.0 * scale, 2e-5);
      if (!(*std::max_element(residual.begin(), residual.end()) > cut)) break;  // nothing to reject
      for (std::size_t j = 0; j < n; ++j) {
        const double u = residual[j] / cut, v = 1.0 - u * u;
        weight[j] = u < 1.0 ? base[j] * v * v : 0.0;
      }
      fit = solve(s, r, w, at[k], weight.data());
    }
    double sum = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      const double t = (s[w.first + j] - at[k]) / w.half_width;
      const double l =
          weight[j] * (fit.weights_of_value[0] + t * (fit.weights_of_value[1] + t * fit.weights_of_value[2]));
      sum += l * l;
    }
    const double dof = n > 3 ? std::sqrt(double(n) / (double(n) - 3.0)) : 1.0;
    out[k] = {fit.a, scale * dof * std::sqrt(sum), static_cast<int>(n), w.half_width};
  }
  return out;
}

double fit_gain(double half_width, double wavelength) {
  // Equivalent kernel of the parabola with tricube weights, integrated by Simpson's rule.
  constexpr int n = 400;
  double m0 = 0, m2 = 0, m4 = 0, c0 = 0, c2 = 0;
  for (int i = 0; i <= n; ++i) {
    const double t = double(i) / n, q = (i == 0 || i == n ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0)) * tricube(t);
    const double c = std::cos(2.0 * std::numbers::pi * t * half_width / wavelength);
    m0 += q;
    m2 += q * t * t;
    m4 += q * t * t * t * t;
    c0 += q * c;
    c2 += q * t * t * c;
  }
  return (m4 * c0 - m2 * c2) / (m0 * m4 - m2 * m2);
}

std::vector<double> interpolated(std::span<const double> s, std::span<const double> x, std::span<const double> at,
                                 double max_gap) {
  std::vector<double> out(at.size(), nan);
  std::size_t i = 0;
  for (std::size_t k = 0; k < at.size(); ++k) {
    i = advance(s, i, at[k]);
    if (covered(s, i, at[k], max_gap)) out[k] = at_line(s, x, i, at[k]);
  }
  return out;
}

}  // namespace versine::track
