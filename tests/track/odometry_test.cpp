// SPDX-License-Identifier: Apache-2.0
#include "versine/track/odometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/ellipsoid.hpp"

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
  const auto o = combine_odometers(wheels, nullptr, {}, record).odometer;
  EXPECT_NEAR(o.back().distance, 1000.0, 0.5);  // 0.05 %
  EXPECT_NEAR(o.back().distance, 1000.0 * 1.00005, 0.03);
  ASSERT_EQ(record.findings.size(), 1u);
  EXPECT_NEAR(record.findings[0].from.seconds(), 400.0, 2.0);
  EXPECT_TRUE(o.strictly_increasing());
}

/// 1000 m north on a slope of 20 permille, known to `sigma` at both ends; the IMU looks to the right of the trolley.
geodesy::Trajectory climb(double sigma) {
  geodesy::Trajectory t;
  const geodesy::Geodetic start{0.9, 0.2, 0.0};
  const double metre = 1.0 / geodesy::wgs84.meridian_radius(start.latitude);
  for (int i = 0; i <= 10000; ++i) {
    const double s = 0.1 * i;
    geodesy::TrajectoryPoint p;
    p.time = Time{i * 100'000'000LL};
    p.position = {start.latitude + s * metre, start.longitude, start.height + 0.02 * s};
    p.q_nb = geodesy::to_quaternion(geodesy::Euler{0.0, std::atan(0.02), 0.0}) *
             Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ()));
    p.position_covariance = geodesy::Covariance3::from(Eigen::Matrix3d(Eigen::Matrix3d::Identity() * sigma * sigma));
    t.samples.push_back(p);
  }
  return t;
}

TEST(Odometry, TheTrajectoryLevelsAndCalibratesTheWheels) {
  const double slope = std::hypot(1.0, 0.02);
  RunRecord record;
  const std::vector<Series<sensors::OdometerSample>> wheels = {wheel(slope * 1.0004, 400.0, -0.5),
                                                               wheel(slope * 1.0002, 1e9, 0.0)};
  OdometerOptions options;
  options.forward = -Eigen::Vector3d::UnitY();
  const auto known = climb(1e-3), vague = climb(1.0);
  const auto a = combine_odometers(wheels, &known, options, record);
  constexpr double length = 1000.0;
  EXPECT_NEAR(a.odometer.back().distance / length, 1.0, 1e-5);
  EXPECT_NEAR(a.scale, 1.0 / 1.0003, 1e-5);
  EXPECT_NEAR(a.scale_sigma, std::sqrt(2.0) * 1e-6, 1e-7);
  ASSERT_EQ(record.findings.size(), 1u);
  // A trajectory that is known to a metre says nothing against wheels of 3e-4.
  const auto b = combine_odometers(wheels, &vague, options, record);
  EXPECT_NEAR(b.scale, 1.0, 5e-5);
  EXPECT_NEAR(b.scale_sigma, 3e-4, 1e-5);
  EXPECT_NEAR(b.odometer.back().distance / length, 1.0003, 5e-5);
}

}  // namespace
}  // namespace versine::track
