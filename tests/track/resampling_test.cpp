// SPDX-License-Identifier: Apache-2.0
#include "versine/track/resampling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "versine/core/numbers.hpp"

namespace versine::track {
namespace {

using Eigen::Vector3d;

std::vector<double> grid(double from, double to, double step) {
  std::vector<double> g;
  for (int i = 0; from + i * step <= to + 1e-9; ++i) g.push_back(from + i * step);
  return g;
}

/// Samples with a speed that varies fivefold, as a pushed trolley's do.
std::vector<double> uneven(double to) {
  std::vector<double> s{0.0};
  while (s.back() < to) s.push_back(s.back() + 0.006 * (3.0 + 2.0 * std::sin(0.37 * s.back())));
  return s;
}

double amplitude(const std::vector<double>& at, const std::vector<double>& y, double wavelength) {
  double a = 0, n = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    a += y[i] * std::sin(two_pi * at[i] / wavelength);
    n += std::pow(std::sin(two_pi * at[i] / wavelength), 2);
  }
  return a / n;
}

TEST(Resampling, FrequencyResponsesAreTheDeclaredOnes) {
  const auto s = uneven(70.0);
  for (const double wavelength : {0.6, 1.0, 1.5, 3.0, 6.0, 10.0}) {
    std::vector<double> x;
    std::vector<Vector3d> r;
    for (const double v : s) {
      x.push_back(std::sin(two_pi * v / wavelength));
      r.push_back({1000 + v, 0.001 * x.back(), 0.0});
    }
    const auto at = grid(3.0, 63.0, 0.25);
    EXPECT_NEAR(amplitude(at, moving_average(s, x, at, 0.25, 1.0), wavelength), moving_average_gain(0.25, wavelength),
                0.005);
    std::vector<double> y;
    for (const auto& p : fit_moving(s, r, at, 0.5, 1.0)) y.push_back(p.r.y() / 0.001);
    EXPECT_NEAR(amplitude(at, y, wavelength), fit_gain(0.5, wavelength), 0.01) << wavelength;
  }
  EXPECT_GT(fit_gain(0.5, 3.0), 0.998);  // D1 is left alone
}

TEST(Resampling, FitKeepsAParabolaExactlyAndIgnoresWildSamples) {
  const auto s = uneven(20.0);
  std::vector<Vector3d> r;
  for (std::size_t i = 0; i < s.size(); ++i) {
    r.push_back({s[i], 0.5 * s[i] * s[i] / 300.0, 0.01 * s[i]});
    if (i % 40 == 7) r.back() += Vector3d(0.01, -0.02, 0.0);
  }
  const auto at = grid(1.0, 19.0, 0.25);
  const auto fit = fit_moving(s, r, at, 0.5, 1.0);
  for (std::size_t k = 0; k < at.size(); ++k) EXPECT_NEAR(fit[k].r.y(), 0.5 * at[k] * at[k] / 300.0, 2e-7);
}

TEST(Resampling, FitSigmaCoversWhiteNoise) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 1e-3);
  const auto s = uneven(400.0);
  std::vector<Vector3d> r;
  for (const double v : s) r.push_back({v + noise(random), noise(random), 0.0});
  const auto at = grid(1.0, 399.0, 1.0);  // independent windows
  int inside = 0;
  for (const auto& p : fit_moving(s, r, at, 0.5, 1.0)) inside += std::abs(p.r.y()) < 1.96 * p.sigma;
  const double share = inside / double(at.size());
  EXPECT_GT(share, 0.90);
  EXPECT_LT(share, 0.985);
}

TEST(Resampling, GapsGiveNothingAndSparseSamplesWidenTheFit) {
  std::vector<double> s;
  std::vector<Vector3d> r;
  std::vector<double> x;
  for (double v = 0; v < 10; v += 0.4) s.push_back(v);
  for (double v = 15; v < 25; v += 0.4) s.push_back(v);
  for (const double v : s) {
    r.push_back({v, 2.0, 0.0});
    x.push_back(v);
  }
  const auto at = grid(0.0, 24.0, 0.25);
  const auto fit = fit_moving(s, r, at, 0.3, 1.0);
  const auto mean = moving_average(s, x, at, 0.25, 1.0);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const bool gap = at[k] > 9.6 && at[k] < 15;
    EXPECT_EQ(std::isnan(mean[k]), gap) << at[k];
    EXPECT_EQ(std::isnan(fit[k].r.x()), gap) << at[k];
    if (gap) continue;
    EXPECT_NEAR(mean[k], at[k], 1e-9);
    EXPECT_NEAR(fit[k].r.x(), at[k], 1e-6);
  }
}

TEST(Resampling, MedianTakesOutJointsAndKeepsTrends) {
  std::vector<double> s, x;
  for (int i = 0; i < 200; ++i) {
    s.push_back(0.02 * i);
    x.push_back(0.001 * i + (i == 50 || i == 51 ? 0.5 : 0.0));
  }
  const auto y = median_filter(s, x, 0.15);
  for (int i = 0; i < 200; ++i) EXPECT_NEAR(y[i], 0.001 * i, 0.0031) << i;
  EXPECT_EQ(y[120], x[120]);
}

}  // namespace
}  // namespace versine::track
