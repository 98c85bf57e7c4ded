// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "versine/core/units.hpp"
#include "versine/inertial/alignment.hpp"
#include "versine/inertial/earth_rate.hpp"

namespace versine::inertial {
namespace {

/// A vehicle that stands with the given heading and rocks by `rock` rad with a period of 2 s and a slow lean of half of
/// it: exact rates and gravity, plus white noise. Its springs settle by `settle` rad over the time.
sensors::ImuSeries standing_imu(double heading, double rock, double seconds, double settle = 0.0) {
  const geodesy::Geodetic place{0.6, 1.9, 380.0};
  const double omega = geodesy::wgs84.omega();
  const Eigen::Vector3d earth(omega * std::cos(place.latitude), 0.0, -omega * std::sin(place.latitude));
  const Eigen::Vector3d force_n = -geodesy::wgs84.gravity_ned(place.latitude, place.height);
  const auto attitude = [&](double t) {
    const double lean = settle * t / seconds;
    return geodesy::to_quaternion({0.01 + rock * std::sin(3.14 * t) + 0.5 * rock * std::sin(0.02 * t) + lean,
                                   -0.02 + 0.7 * rock * std::sin(2.7 * t) - 0.5 * lean, heading});
  };
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  sensors::ImuSeries imu;
  imu.interval = Duration::from_seconds(0.01);
  for (int k = 1; k <= static_cast<int>(100 * seconds); ++k) {
    const double t = 0.01 * k;
    const Eigen::Quaterniond from = attitude(t - 0.01), to = attitude(t), middle = attitude(t - 0.005);
    sensors::ImuSample s;
    s.time = Time::from_seconds(t);
    const Eigen::Quaterniond turn = from.conjugate() * geodesy::from_rotation_vector(0.01 * earth) * to;
    s.dtheta = geodesy::to_rotation_vector(turn);
    s.dvel = 0.01 * (middle.conjugate() * force_n);
    for (int i = 0; i < 3; ++i) s.dtheta(i) += 1e-8 * normal(random), s.dvel(i) += 1e-5 * normal(random);
    imu.samples.push_back(s);
  }
  return imu;
}

TEST(Gyrocompass, FindsHeadingWhetherItRocksOrNot) {
  const auto errors = sensors::find_imu_grade("navigation-rlg")->errors;
  for (const double rock : {0.0, 0.003}) {
    for (const double heading : {-2.5, 0.3, 1.58}) {
      const auto imu = standing_imu(heading, rock, 120.0);
      const auto a = gyrocompass(imu, {{0}, Time::from_seconds(120)}, {0.6, 1.9, 380.0}, errors);
      ASSERT_TRUE(a) << a.error().message();
      const geodesy::Euler e = geodesy::to_euler(a->q_nb);
      EXPECT_NEAR(geodesy::wrap_pi(e.yaw - heading), 0.0, 3.0 * a->sigma.z()) << rock;
      EXPECT_LT(a->sigma.z(), 0.5 * units::deg) << rock;
      EXPECT_NEAR(e.pitch, -0.02, 1e-3);
    }
  }
}

TEST(EarthRate, IsSeenThroughRockingAndSettling) {
  const auto errors = sensors::find_imu_grade("navigation-rlg")->errors;
  for (const auto& [rock, settle] : {std::pair{0.0, 0.0}, {0.003, 0.0}, {0.0, 0.003}, {0.001, -0.003}}) {
    const auto imu = standing_imu(1.0, rock, 600.0, settle);
    const auto e = measured_earth_rate(imu, {{0}, Time::from_seconds(600)}, errors);
    ASSERT_TRUE(e);
    EXPECT_NEAR(e->omega_ib_b.norm(), geodesy::wgs84.omega(), 3.0 * e->sigma) << rock << ' ' << settle;
    EXPECT_NEAR(e->vertical, geodesy::wgs84.omega() * std::sin(0.6), 3.0 * e->sigma) << rock << ' ' << settle;
    EXPECT_NEAR(e->horizontal, geodesy::wgs84.omega() * std::cos(0.6), 3.0 * e->sigma) << rock << ' ' << settle;
    EXPECT_LT(e->sigma, 0.1 * units::deg_per_hour) << rock << ' ' << settle;
  }
  EXPECT_FALSE(measured_earth_rate(standing_imu(1.0, 0.0, 30.0), {{0}, Time::from_seconds(30)}, errors));
}

TEST(EarthRate, TellsTheLatitude) {
  const auto errors = sensors::find_imu_grade("navigation-rlg")->errors;
  const auto e = measured_earth_rate(standing_imu(1.0, 0.001, 120.0), {{0}, Time::from_seconds(120)}, errors);
  ASSERT_TRUE(e);
  EXPECT_TRUE(check_latitude(*e, {0.6, 1.9, 380.0}, "gnss.csv"));
  const auto swapped = check_latitude(*e, {1.9, 0.6, 380.0}, "gnss.csv");
  ASSERT_FALSE(swapped);
  EXPECT_NE(swapped.error().advice.find("swapped"), std::string::npos);
  EXPECT_FALSE(check_latitude(*e, {-0.6, 1.9, 380.0}, "gnss.csv"));
  EarthRate coarse = *e;
  coarse.sigma = 0.1 * geodesy::wgs84.omega();
  EXPECT_TRUE(check_latitude(coarse, {1.9, 0.6, 380.0}, "gnss.csv"));
}

// The mean of the rates, which this replaced, was 71 degrees wrong on a real rocking vehicle, with a sigma of 0.5.
TEST(Gyrocompass, RefusesGyrosThatSeeNoEarthRate) {
  const auto imu = standing_imu(1.0, 0.0, 60.0);
  const auto a =
      gyrocompass(imu, {{0}, Time::from_seconds(60)}, {0.6, 1.9, 380.0}, sensors::find_imu_grade("mems")->errors);
  ASSERT_FALSE(a);
  EXPECT_FALSE(a.error().advice.empty());
}

}  // namespace
}  // namespace versine::inertial
