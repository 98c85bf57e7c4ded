// SPDX-License-Identifier: Apache-2.0
#include "versine/track/versine.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <deque>
#include <numbers>

#include "versine/core/numbers.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::track {
namespace {

/// A distance in steps: whole part, and what is left.
struct Lag {
  std::ptrdiff_t whole = 0;
  double part = 0.0;
  Lag(double distance, double step) {
    const double n = distance / step;
    whole = std::llround(n);
    if (std::abs(n - double(whole)) > 1e-6) {
      whole = static_cast<std::ptrdiff_t>(std::floor(n));
      part = n - double(whole);
    }
  }
};

/// Value `lag` away from index i: on the grid as it is, between by the cubic through four points.
template <class T>
T shifted(std::span<const T> x, std::size_t i, const Lag& lag, const T& none) {
  const std::ptrdiff_t k = static_cast<std::ptrdiff_t>(i) + lag.whole, n = static_cast<std::ptrdiff_t>(x.size());
  if (k < 0 || k >= n) return none;
  const auto at = [&](std::ptrdiff_t j) -> const T& { return x[static_cast<std::size_t>(j)]; };
  if (lag.part == 0.0) return at(k);
  if (k + 1 >= n) return none;
  const double t = lag.part;
  if (k < 1 || k + 2 >= n) return at(k) * (1.0 - t) + at(k + 1) * t;
  return at(k - 1) * (-t * (t - 1) * (t - 2) / 6) + at(k) * ((t + 1) * (t - 1) * (t - 2) / 2) +
         at(k + 1) * (-(t + 1) * t * (t - 2) / 2) + at(k + 2) * ((t + 1) * t * (t - 1) / 6);
}

double value_at(std::span<const double> x, std::size_t i, const Lag& lag) {
  return shifted<double>(x, i, lag, nan);
}

}  // namespace

double horizontal_versine(const Eigen::Vector3d& P, const Eigen::Vector3d& A, const Eigen::Vector3d& B,
                          const Eigen::Vector3d& up) {
  const Eigen::Vector3d chord = (B - A) - up * up.dot(B - A);
  return (P - A).cross(chord).dot(up) / chord.norm();
}

std::vector<double> horizontal_versines(std::span<const Eigen::Vector3d> rail, double step, const Chord& chord) {
  std::vector<double> out(rail.size(), nan);
  const Lag back(-chord.offset, step), ahead(chord.length - chord.offset, step);
  const Eigen::Vector3d none = Eigen::Vector3d::Constant(nan);
  // Normal of the ellipsoid from ECEF: (x, y, z / (1 - e^2)) is right at height 0 and within 1e-8 rad at 4 km.
  const double k = 1.0 / (1.0 - geodesy::wgs84.e2());
  for (std::size_t i = 0; i < rail.size(); ++i) {
    const Eigen::Vector3d A = shifted<Eigen::Vector3d>(rail, i, back, none);
    const Eigen::Vector3d B = shifted<Eigen::Vector3d>(rail, i, ahead, none);
    const Eigen::Vector3d up = Eigen::Vector3d(rail[i].x(), rail[i].y(), rail[i].z() * k).normalized();
    out[i] = horizontal_versine(rail[i], A, B, up);
  }
  return out;
}

std::vector<double> scalar_versines(std::span<const double> e, double step, const Chord& chord) {
  std::vector<double> out(e.size(), nan);
  const Lag back(-chord.offset, step), ahead(chord.length - chord.offset, step);
  const double part = chord.offset / chord.length;
  for (std::size_t i = 0; i < e.size(); ++i) {
    out[i] = e[i] - (1.0 - part) * value_at(e, i, back) - part * value_at(e, i, ahead);
  }
  return out;
}

std::vector<double> chord_check(std::span<const double> e, double step, const ChordCheck& c) {
  std::vector<double> out(e.size(), nan);
  const Lag start(-c.first, step), end(c.length - c.first, step), second(c.distance, step);
  for (std::size_t i = 0; i < e.size(); ++i) {
    out[i] = e[i] - value_at(e, i, second) + c.distance / c.length * (value_at(e, i, end) - value_at(e, i, start));
  }
  return out;
}

std::vector<double> chord_check_worst(std::span<const double> e, double step, const ChordCheck& c) {
  const std::size_t n = e.size();
  std::vector<double> rise(n, nan), out(n, nan);
  const Lag length(c.length, step), second(c.distance, step);
  for (std::size_t i = 0; i < n; ++i) rise[i] = value_at(e, i, length) - e[i];
  // Chords that hold the pair begin between P + distance - length and P: extremes of a sliding window, in linear time.
  const auto width = static_cast<std::size_t>(std::floor((c.length - c.distance) / step + 1e-6));
  std::deque<std::size_t> high, low;
  for (std::size_t i = 0; i < n; ++i) {
    if (std::isfinite(rise[i])) {
      while (!high.empty() && rise[high.back()] <= rise[i]) high.pop_back();
      while (!low.empty() && rise[low.back()] >= rise[i]) low.pop_back();
      high.push_back(i);
      low.push_back(i);
    }
    while (!high.empty() && high.front() + width < i) high.pop_front();
    while (!low.empty() && low.front() + width < i) low.pop_front();
    if (high.empty()) continue;
    const double d = e[i] - value_at(e, i, second), f = c.distance / c.length;
    const double a = d + f * rise[high.front()], b = d + f * rise[low.front()];
    out[i] = std::abs(a) >= std::abs(b) ? a : b;
  }
  return out;
}

double chord_check_gain(const ChordCheck& c, double wavelength) {
  const double a = 2.0 * std::numbers::pi / wavelength;
  const auto wave = [a](double x) { return std::polar(1.0, a * x); };
  return std::abs(1.0 - wave(c.distance) + c.distance / c.length * (wave(c.length - c.first) - wave(-c.first)));
}

double grid_value(std::span<const double> x, double index) {
  if (!(index >= 0.0)) return nan;
  const auto i = static_cast<std::size_t>(index);
  return i >= x.size() ? nan : value_at(x, i, Lag(index - double(i), 1.0));
}

}  // namespace versine::track
