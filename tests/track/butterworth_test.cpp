// SPDX-License-Identifier: Apache-2.0
#include "versine/track/butterworth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace versine::track {
namespace {

constexpr double pi = std::numbers::pi;

/// The analogue band-pass that the filter stands for.
double theory(double shortest, double longest, int order, double wavelength) {
  const double f = 1.0 / wavelength, f1 = 1.0 / longest, f2 = 1.0 / shortest;
  const double w = (f * f - f1 * f2) / ((f2 - f1) * f);
  return 1.0 / (1.0 + (std::numbers::sqrt2 - 1.0) * std::pow(std::abs(w), 2.0 * order));
}

TEST(Butterworth, GainIsMinusThreeDecibelAtBothEdgesAndFollowsTheory) {
  struct Case {
    double shortest, longest;
  };
  for (const auto [a, b] : {Case{3, 25}, Case{25, 70}, Case{70, 150}, Case{70, 200}, Case{1, 5}}) {
    for (const int order : {2, 3, 4}) {
      const auto sections = band_pass(a, b, 0.25, order);
      EXPECT_NEAR(gain_both_ways(sections, a, 0.25), std::sqrt(0.5), 1e-9);
      EXPECT_NEAR(gain_both_ways(sections, b, 0.25), std::sqrt(0.5), 1e-9);
      if (a < 3) continue;  // near the Nyquist wavelength (and below `a`) the bilinear transform steepens the skirt
      for (double w = a; w < 3 * b; w *= 1.1) {
        EXPECT_NEAR(gain_both_ways(sections, w, 0.25), theory(a, b, order, w), 0.01) << w;
      }
    }
  }
}

TEST(Butterworth, SinePassesWithTheDeclaredGainAndWithoutShift) {
  const double step = 0.25;
  const std::size_t n = 8000;
  for (const double wavelength : {4.0, 10.0, 20.0, 40.0, 50.0}) {
    std::vector<double> x(n);
    for (std::size_t i = 0; i < n; ++i)
      x[i] = std::sin(2 * pi * step * static_cast<double>(i) / wavelength) + 7 + 0.01 * double(i);
    const auto sections = band_pass(3, 25, step, 4);
    const auto y = filter_both_ways(sections, x, 800);
    double in_phase = 0, quadrature = 0;
    const std::size_t from = 2000, to = 6000;  // whole periods of all of them
    for (std::size_t i = from; i < to; ++i) {
      const double a = 2 * pi * step * static_cast<double>(i) / wavelength;
      in_phase += y[i] * std::sin(a) * 2.0 / double(to - from);
      quadrature += y[i] * std::cos(a) * 2.0 / double(to - from);
    }
    EXPECT_NEAR(in_phase, theory(3, 25, 4, wavelength), 0.01) << wavelength;
    EXPECT_NEAR(quadrature, 0.0, 1e-3) << wavelength;
  }
}

TEST(Butterworth, TrendLeavesNothingNotEvenAtTheEnds) {
  std::vector<double> x(2000);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = 100 + 0.02 * double(i);
  for (const double v : filter_both_ways(band_pass(3, 25, 0.25, 4), x, 600)) EXPECT_NEAR(v, 0.0, 2e-3);
}

TEST(Butterworth, PiecesBetweenMissingValuesAreFilteredAlone) {
  std::vector<double> x(3000, 1.0);
  for (std::size_t i = 0; i < 3000; ++i) x[i] = std::sin(0.2 * double(i));
  std::vector<double> first(x.begin(), x.begin() + 1500);
  x[1500] = std::numeric_limits<double>::quiet_NaN();
  const auto sections = band_pass(3, 25, 0.25, 4);
  const auto y = filter_both_ways(sections, x, 400), y1 = filter_both_ways(sections, first, 400);
  EXPECT_TRUE(std::isnan(y[1500]));
  for (std::size_t i = 0; i < 1500; ++i) EXPECT_EQ(y[i], y1[i]);
  EXPECT_TRUE(std::isfinite(y[1501]));
}

TEST(Butterworth, LowPassKeepsTheMeanAndHasItsEdge) {
  const auto sections = low_pass(100, 0.25, 4);
  EXPECT_NEAR(gain_both_ways(sections, 100, 0.25), std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(gain_both_ways(sections, 1e9, 0.25), 1.0, 1e-9);
  EXPECT_LT(gain_both_ways(sections, 25, 0.25), 1e-4);
}

}  // namespace
}  // namespace versine::track
