// SPDX-License-Identifier: Apache-2.0
#include "versine/track/butterworth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace versine::track {
namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi;

/// Poles of the analogue low-pass of unit cut-off, upper half plane (and the real one of an odd order).
std::vector<Complex> prototype(int order) {
  std::vector<Complex> poles;
  for (int k = 0; k < (order + 1) / 2; ++k) {
    poles.push_back(std::polar(1.0, pi * (2.0 * k + order + 1.0) / (2.0 * order)));
  }
  return poles;
}

/// Cut-off of the prototype for which both passes together lose 3 dB at 1.
double widened(int order) {
  return std::pow(std::numbers::sqrt2 - 1.0, -0.5 / order);
}

/// Bilinear transform of an analogue pole, s = (1 - 1/z) / (1 + 1/z).
Complex digital(Complex s) {
  return (1.0 + s) / (1.0 - s);
}
/// The analogue frequency that the bilinear transform maps to a wavelength.
double warped(double wavelength, double step) {
  return std::tan(pi * step / wavelength);
}

Complex response(const Biquad& q, Complex z1) {
  return (q.b0 + z1 * (q.b1 + z1 * q.b2)) / (1.0 + z1 * (q.a1 + z1 * q.a2));
}

/// Section with the given poles and numerator shape, of gain 1 at z1 = exp(-i w).
Biquad section(Complex p, Complex q, double n1, double n2, Complex z1) {
  Biquad b{1.0, n1, n2, -(p + q).real(), (p * q).real()};
  const double g = 1.0 / std::abs(response(b, z1));
  b.b0 *= g;
  b.b1 *= g;
  b.b2 *= g;
  return b;
}

void run(std::span<const Biquad> sections, std::vector<double>& x) {
  for (const Biquad& q : sections) {
    double s1 = 0.0, s2 = 0.0;  // transposed direct form II
    for (double& v : x) {
      const double y = q.b0 * v + s1;
      s1 = q.b1 * v - q.a1 * y + s2;
      s2 = q.b2 * v - q.a2 * y;
      v = y;
    }
  }
}

void filter_piece(std::span<const Biquad> sections, std::span<const double> x, std::size_t settle, double* out) {
  const std::size_t n = x.size(), pad = std::min(settle, n - 1);
  std::vector<double> work;
  work.reserve(n + 2 * pad);
  for (std::size_t i = pad; i > 0; --i) work.push_back(2.0 * x.front() - x[i]);
  work.insert(work.end(), x.begin(), x.end());
  for (std::size_t i = 1; i <= pad; ++i) work.push_back(2.0 * x.back() - x[n - 1 - i]);
  run(sections, work);
  std::reverse(work.begin(), work.end());
  run(sections, work);
  for (std::size_t i = 0; i < n; ++i) out[i] = work[work.size() - 1 - pad - i];
}

}  // namespace

std::vector<Biquad> band_pass(double shortest, double longest, double step, int order) {
  if (!(shortest > 2.0 * step) || !(longest > shortest) || order < 1) {
    throw std::invalid_argument("band_pass: longest > shortest > 2 step, order >= 1");
  }
  const double f1 = warped(longest, step), f2 = warped(shortest, step);
  const double centre2 = f1 * f2, width = (f2 - f1) * widened(order);
  const Complex z1 = std::polar(1.0, -2.0 * std::atan(std::sqrt(centre2)));
  std::vector<Biquad> sections;
  for (const Complex p : prototype(order)) {
    // s^2 - p B s + w0^2 = 0: each prototype pole becomes two, and its conjugate their conjugates.
    const Complex half = 0.5 * width * p, root = std::sqrt(half * half - centre2);
    const Complex a = digital(half + root), b = digital(half - root);
    if (std::abs(p.imag()) < 1e-12) {
      sections.push_back(section(a, b, 0.0, -1.0, z1));
    } else {
      sections.push_back(section(a, std::conj(a), 0.0, -1.0, z1));
      sections.push_back(section(b, std::conj(b), 0.0, -1.0, z1));
    }
  }
  return sections;
}

std::vector<Biquad> low_pass(double shortest, double step, int order) {
  if (!(shortest > 2.0 * step) || order < 1) throw std::invalid_argument("low_pass: shortest > 2 step, order >= 1");
  const double cut = warped(shortest, step) * widened(order);
  std::vector<Biquad> sections;
  for (const Complex p : prototype(order)) {
    const Complex a = digital(cut * p);
    if (std::abs(p.imag()) < 1e-12) {
      sections.push_back(section(a, 0.0, 1.0, 0.0, 1.0));
    } else {
      sections.push_back(section(a, std::conj(a), 2.0, 1.0, 1.0));
    }
  }
  return sections;
}

double gain_both_ways(std::span<const Biquad> sections, double wavelength, double step) {
  const Complex z1 = std::polar(1.0, -2.0 * pi * step / wavelength);
  double gain = 1.0;
  for (const Biquad& q : sections) gain *= std::norm(response(q, z1));
  return gain;
}

std::vector<double> filter_both_ways(std::span<const Biquad> sections, std::span<const double> x, std::size_t settle) {
  std::vector<double> out(x.begin(), x.end());
  for (std::size_t i = 0; i < x.size();) {
    if (!std::isfinite(x[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < x.size() && std::isfinite(x[end])) ++end;
    filter_piece(sections, x.subspan(i, end - i), settle, out.data() + i);
    i = end;
  }
  return out;
}

}  // namespace versine::track
