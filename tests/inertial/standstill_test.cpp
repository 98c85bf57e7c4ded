// SPDX-License-Identifier: Apache-2.0
#include "versine/inertial/standstill.hpp"

#include <gtest/gtest.h>

#include <random>

namespace versine::inertial {
namespace {

using Eigen::Vector3d;

/// A smooth ride: what the IMU shows while it stands and while it moves steadily is the same white noise; in between it
/// accelerates for ten seconds.
struct Ride {
  sensors::ImuSeries imu;
  Series<sensors::OdometerSample> odometer;
  Series<sensors::GnssSample> gnss;

  explicit Ride(double stand, double until) {
    std::mt19937 generator(3);
    std::normal_distribution<double> noise;
    imu.interval = Duration::from_seconds(0.01);
    for (int k = 1; k <= static_cast<int>(until * 100.0); ++k) {
      const double t = 0.01 * k, acceleration = t > stand && t <= stand + 10.0 ? 0.5 : 0.0;
      sensors::ImuSample s{Time::from_seconds(t)};
      for (int i = 0; i < 3; ++i) s.dtheta(i) = 1e-6 * noise(generator), s.dvel(i) = 1e-5 * noise(generator);
      s.dvel += 0.01 * Vector3d(acceleration, 0.0, -9.81);
      // A moving vehicle is not quite that smooth in the seconds in which it speeds up.
      if (acceleration > 0.0) s.dvel.x() += 0.003 * noise(generator);
      imu.samples.push_back(s);
    }
    for (int k = 0; k <= static_cast<int>(until); ++k) {
      const double t = k, d = t <= stand          ? 0.0
                              : t <= stand + 10.0 ? 0.25 * (t - stand) * (t - stand)
                                                  : 25.0 + 5.0 * (t - stand - 10.0);
      odometer.samples.push_back({Time::from_seconds(t), d});
      sensors::GnssSample g{Time::from_seconds(t)};
      g.position = {0.8 + d / 6371000.0, 0.2, 100.0};
      g.sigma_ned.setConstant(0.02);
      gnss.samples.push_back(g);
    }
  }
};

double seconds_between(const std::vector<Interval>& all, double from, double to) {
  double sum = 0.0;
  for (const Interval& i : all) {
    sum += std::max(0.0, std::min(to, i.to.seconds()) - std::max(from, i.from.seconds()));
  }
  return sum;
}

TEST(Standstill, IsFoundWithAnyAid) {
  const Ride ride(30.0, 90.0);
  for (const StandstillInput& in : {StandstillInput{.imu = &ride.imu, .odometer = &ride.odometer},
                                    StandstillInput{.imu = &ride.imu, .gnss = &ride.gnss}}) {
    EXPECT_GT(seconds_between(find_standstills(in), 0.0, 30.0), 25.0);
  }
}

TEST(Standstill, EndsWhereTheVehicleSetsOffSmoothly) {
  // 0.5 m/s^2 without any unrest: 0.25 m in the first second, which fixes of 2 cm and a limit of 0.3 m/s let pass.
  Ride ride(30.0, 60.0);
  for (auto& s : ride.imu.samples) {
    if (s.time.seconds() > 30.005 && s.time.seconds() < 40.0) s.dvel.x() = 0.01 * 0.5;
  }
  const auto found = find_standstills({.imu = &ride.imu, .gnss = &ride.gnss});
  EXPECT_GT(seconds_between(found, 0.0, 30.0), 25.0);
  EXPECT_EQ(seconds_between(found, 30.0, 60.0), 0.0);
}

TEST(Standstill, SteadyRideIsNoneWhereAnAidTellsOfIt) {
  const Ride ride(30.0, 90.0);
  // With nothing but the IMU a steady ride looks like standing: documented, and the reason for the aids.
  EXPECT_GT(seconds_between(find_standstills({.imu = &ride.imu}), 42.0, 90.0), 30.0);
  EXPECT_EQ(seconds_between(find_standstills({.imu = &ride.imu, .odometer = &ride.odometer}), 42.0, 90.0), 0.0);
  EXPECT_EQ(seconds_between(find_standstills({.imu = &ride.imu, .gnss = &ride.gnss}), 42.0, 90.0), 0.0);
}

TEST(Standstill, CoarseFixesThatWanderWithinTheirSigmaDoNotBreakIt) {
  Ride ride(60.0, 60.0);
  std::mt19937 generator(5);
  std::normal_distribution<double> noise;
  for (auto& g : ride.gnss.samples) {
    g.sigma_ned.setConstant(2.0);
    g.position.latitude += 1.5 * noise(generator) / 6371000.0;
  }
  EXPECT_GT(seconds_between(find_standstills({.imu = &ride.imu, .gnss = &ride.gnss}), 0.0, 60.0), 55.0);
}

TEST(Standstill, CreepingTrolleyIsNone) {
  Ride ride(60.0, 60.0);
  for (auto& s : ride.odometer.samples) s.distance = 0.004 * s.time.seconds();  // 4 mm/s
  EXPECT_EQ(find_standstills({.imu = &ride.imu, .odometer = &ride.odometer}).size(), 0U);
}

}  // namespace
}  // namespace versine::inertial
