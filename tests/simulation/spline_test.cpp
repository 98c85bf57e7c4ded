// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/spline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace versine::simulation {
namespace {

TEST(UniformSpline, FollowsASineWithItsDerivatives) {
  const double step = 0.1, k = 2.0 * std::numbers::pi / 3.0;  // wavelength 3 m
  UniformSpline<1>::Samples samples(1, 400);
  for (int i = 0; i < 400; ++i) samples(0, i) = std::sin(k * step * i);
  const UniformSpline<1> spline(0.0, step, samples);
  for (double x = 5.0; x < 35.0; x += 0.0371) {
    const auto jet = spline.jet(x);
    EXPECT_NEAR(jet.value(0), std::sin(k * x), 2e-7);
    EXPECT_NEAR(jet.first(0), k * std::cos(k * x), 4e-6);
    EXPECT_NEAR(jet.second(0), -k * k * std::sin(k * x), 2e-4);
    EXPECT_EQ(jet.value(0), spline.value(x)(0));
  }
}

TEST(UniformSpline, DerivativesBelongToTheValues) {
  UniformSpline<2>::Samples samples(2, 100);
  for (int i = 0; i < 100; ++i) samples.col(i) << std::sin(0.9 * i), (i * 7919) % 31;
  const UniformSpline<2> spline(-3.0, 0.5, samples);
  for (double x = 0.0; x < 40.0; x += 0.317) {
    const double h = 1e-4;
    const auto jet = spline.jet(x);
    EXPECT_LT((jet.first - (spline.value(x + h) - spline.value(x - h)) / (2 * h)).norm(), 1e-4);
    EXPECT_LT((jet.second - (spline.value(x + h) - 2 * spline.value(x) + spline.value(x - h)) / (h * h)).norm(), 1e-3);
  }
}

TEST(UniformSpline, PassesThroughSamplesAndReproducesQuintics) {
  UniformSpline<1>::Samples samples(1, 200);
  const auto f = [](double x) { return 1e-6 * std::pow(x - 10.0, 5) + 0.3 * x * x - 4e3; };
  for (int i = 0; i < 200; ++i) samples(0, i) = f(0.1 * i);
  const UniformSpline<1> spline(0.0, 0.1, samples);
  for (double x = 5.0; x < 15.0; x += 0.0123) EXPECT_NEAR(spline.value(x)(0), f(x), 1e-9);
}

}  // namespace
}  // namespace versine::simulation
