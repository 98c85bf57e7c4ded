// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "versine/core/units.hpp"
#include "versine/simulation/allan.hpp"

namespace versine::simulation {
namespace {

TEST(RandomStream, IsFixedBySeedAndName) {
  RandomStream a(7, "imu.gyro"), b(7, "imu.gyro"), c(7, "imu.accelerometer"), d(8, "imu.gyro");
  const double x = a.normal();
  EXPECT_EQ(x, b.normal());
  EXPECT_NE(x, c.normal());
  EXPECT_NE(x, d.normal());
  EXPECT_EQ(run_seed(5, 0), 5U);
  EXPECT_NE(run_seed(5, 1), run_seed(5, 2));
}

TEST(RandomStream, HasTheMomentsItClaims) {
  RandomStream random(3, "moments");
  double m1 = 0, m2 = 0, m4 = 0, e = 0, u = 0;
  const int n = 400000;
  for (int i = 0; i < n; ++i) {
    const double x = random.normal();
    m1 += x / n, m2 += x * x / n, m4 += x * x * x * x / n;
    e += random.exponential(2.5) / n;
    u += random.uniform(-1.0, 3.0) / n;
  }
  EXPECT_NEAR(m1, 0.0, 0.008);
  EXPECT_NEAR(m2, 1.0, 0.01);
  EXPECT_NEAR(m4, 3.0, 0.08);
  EXPECT_NEAR(e, 2.5, 0.02);
  EXPECT_NEAR(u, 1.0, 0.01);
}

TEST(GaussMarkov, AutocovarianceIsExponential) {
  const double sigma = 2.0, tau = 5.0, step = 0.5;
  RandomStream random(1, "gm");
  double c0 = 0, c10 = 0;
  std::size_t n = 0;
  for (int run = 0; run < 400; ++run) {
    GaussMarkov process(sigma, tau, step, random);
    std::vector<double> x(1000);
    for (double& v : x) v = process.next(random);
    for (std::size_t i = 0; i + 10 < x.size(); ++i, ++n) c0 += x[i] * x[i], c10 += x[i] * x[i + 10];
  }
  EXPECT_NEAR(c0 / static_cast<double>(n), 4.0, 0.1);
  EXPECT_NEAR(c10 / static_cast<double>(n), 4.0 * std::exp(-1.0), 0.1);
}

TEST(Allan, WhiteNoiseAndDriftInClosedForm) {
  RandomStream random(2, "allan");
  std::vector<double> increments(400000);
  const double arw = 0.02, dt = 0.01;
  for (double& x : increments) x = arw * std::sqrt(dt) * random.normal();
  const auto curve = allan_deviation(increments, dt);
  EXPECT_NEAR(random_walk_of(curve, dt, 10.0), arw, 0.02 * arw);
  // A ramp r t has the Allan deviation r tau / sqrt(2).
  for (std::size_t i = 0; i < increments.size(); ++i) increments[i] = 3e-4 * (static_cast<double>(i) + 0.5) * dt * dt;
  for (const AllanPoint& p : allan_deviation(increments, dt)) {
    EXPECT_NEAR(p.deviation, 3e-4 * p.tau / std::numbers::sqrt2, 1e-6 * p.tau);
  }
}

TEST(FlickerNoise, AllanFloorIsFlatAtTheBiasInstability) {
  const double B = 0.1 * units::deg_per_hour, dt = 0.1;
  RandomStream random(4, "flicker");
  std::vector<double> sum;
  std::vector<double> taus;
  const int runs = 30;
  for (int run = 0; run < runs; ++run) {
    FlickerNoise noise(B, dt, 1e5, random);
    std::vector<double> increments(36000);
    for (double& x : increments) x = noise.next(random) * dt;
    const auto curve = allan_deviation(increments, dt, 2);
    sum.resize(curve.size(), 0.0);
    taus.resize(curve.size());
    for (std::size_t i = 0; i < curve.size(); ++i) {
      sum[i] += curve[i].deviation * curve[i].deviation / runs;
      taus[i] = curve[i].tau;
    }
  }
  for (std::size_t i = 0; i < taus.size(); ++i) {
    if (taus[i] < 1.0 || taus[i] > 500.0) continue;
    EXPECT_NEAR(std::sqrt(sum[i]) / B, std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi), 0.07) << taus[i];
  }
}

TEST(RandomWalk, VarianceGrowsWithTime) {
  RandomStream random(9, "walk");
  double variance = 0.0;
  for (int run = 0; run < 2000; ++run) {
    RandomWalk walk(0.5, 0.1);
    double x = 0.0;
    for (int i = 0; i < 100; ++i) x = walk.next(random);
    variance += x * x / 2000;
  }
  EXPECT_NEAR(variance, 0.25 * 10.0, 0.25);
}

}  // namespace
}  // namespace versine::simulation
