// SPDX-License-Identifier: Apache-2.0
#include "versine/track/odometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace versine::track {
namespace {

Series<sensors::OdometerSample> wheel(double scale, double slip_at, double slip) {
  Series<sensors::OdometerSample> o;
  for (int i = 0; i <= 50000; ++i) {
    const double d = 0.02 * i;
    o.samples.push_back({Time{i * 20'000'000LL}, scale * d + (d > slip_at ? slip : 0.0)});
  }
  return o;
}

TEST(Odometry, QuadratureTellsDirection) {
  std::vector<QuadratureSample> q;
  const bool a[] = {false, true, true, false}, b[] = {false, false, true, true};
  int k = 0;
  for (int i = 0; i <= 8; ++i, ++k) q.push_back({Time{k}, a[i % 4], b[i % 4]});
  for (int i = 7; i >= 5; --i, ++k) q.push_back({Time{k}, a[i % 4], b[i % 4]});
  const auto r = decode_quadrature(q, 0.01);
  EXPECT_NEAR(r.odometer[8].distance, 0.08, 1e-12);
  EXPECT_NEAR(r.odometer.back().distance, 0.05, 1e-12);
  EXPECT_EQ(r.illegal, 0u);
}

TEST(Odometry, SlipOfOneWheelIsFoundAndCostsLittle) {
  RunRecord record;
  const std::vector<Series<sensors::OdometerSample>> wheels = {wheel(1.0002, 400.0, -0.5), wheel(0.9999, 1e9, 0.0)};
  const auto o = combine_odometers(wheels, nullptr, {}, record);
  EXPECT_NEAR(o.back().distance, 1000.0, 0.5);  // 0.05 %
  EXPECT_NEAR(o.back().distance, 1000.0 * 1.00005, 0.03);
  ASSERT_EQ(record.findings.size(), 1u);
  EXPECT_NEAR(record.findings[0].from.seconds(), 400.0, 2.0);
  EXPECT_TRUE(o.strictly_increasing());
}

}  // namespace
}  // namespace versine::track
