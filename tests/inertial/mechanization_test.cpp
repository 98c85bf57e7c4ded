// SPDX-License-Identifier: Apache-2.0
#include "versine/inertial/mechanization.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "inertial/synthetic_motion.hpp"
#include "versine/core/units.hpp"

namespace versine::inertial {
namespace {
using Eigen::Vector3d;

struct Difference {
  Vector3d position, velocity, attitude;
};
Difference difference(const NavState& a, const NavState& b) {
  return {geodesy::wgs84.ned_difference(b.position, a.position), a.v_eb_n - b.v_eb_n,
          geodesy::to_rotation_vector(a.q_nb * b.q_nb.conjugate())};
}

TEST(Mechanization, ErrorFreeMotionIntegratesToItsTruth) {
  for (const test::Motion& m : {test::Motion{.speed = 0.0, .swing = 0.0},
                                test::Motion{.speed = 1.0, .swing = 0.5, .turn = 0.3, .climb = 0.02, .roll = 0.1},
                                test::Motion{.speed = 25.0, .swing = 15.0, .turn = 1.5, .climb = 0.08, .roll = 0.3}}) {
    const test::Recording r = test::record(m, 120.0);
    const Difference d = difference(integrate(r.truth.front(), r.imu).back(), r.truth.back());
    EXPECT_LT(d.position.norm(), 1e-3) << d.position.transpose();
    EXPECT_LT(d.velocity.norm(), 2e-5) << d.velocity.transpose();
    EXPECT_LT(d.attitude.norm(), 1e-8) << d.attitude.transpose();
  }
}

TEST(Mechanization, ATenMinuteStandstillStays) {
  const test::Recording r = test::record({.speed = 0.0}, 600.0, 50.0);
  const Difference d = difference(integrate(r.truth.front(), r.imu).back(), r.truth.back());
  EXPECT_LT(d.position.norm(), 1e-4);
}

TEST(Mechanization, ConingIsCompensated) {
  // Classic coning: a constant tilt whose axis goes round at 10 Hz; the mean rate about the cone's axis is
  // omega (1 - cos tilt) = 31.4 mrad/s * ... and shows only through the cross products.
  const double tilt = 0.01, omega = 2.0 * M_PI * 5.0, dt = 0.005;
  const auto q = [&](double t) {
    return geodesy::from_rotation_vector({tilt * std::cos(omega * t), tilt * std::sin(omega * t), 0.0});
  };
  const auto rate = [&](double t) -> Vector3d {
    const double h = 1e-5;
    return geodesy::to_rotation_vector(q(t - h).conjugate() * q(t + h)) / (2.0 * h);
  };
  Eigen::Quaterniond plain = q(0.0), compensated = q(0.0);
  Increment previous;
  for (int i = 0; i < 2000; ++i) {
    Increment now;
    now.dt = dt;
    for (int k = 0; k < 10; ++k) now.rotation += rate((i + (k + 0.5) / 10.0) * dt) * dt / 10.0;
    plain = plain * geodesy::from_rotation_vector(now.rotation);
    compensated = compensated * geodesy::from_rotation_vector(with_coning_and_sculling(previous, now).rotation);
    previous = now;
  }
  const double drift_plain = geodesy::to_rotation_vector(plain * q(10.0).conjugate()).norm();
  const double drift = geodesy::to_rotation_vector(compensated * q(10.0).conjugate()).norm();
  EXPECT_GT(drift_plain, 1e-5);
  EXPECT_LT(drift, 0.02 * drift_plain);
}

TEST(Mechanization, ConingFactorForUnequalIntervals) {
  // Linear rate: the increments of 7 ms after 3 ms give the rotation that 10,000 small steps give.
  const Vector3d a(0.3, -0.2, 0.5), b(4.0, 9.0, -7.0);
  const auto rotation = [&](double from, double to) -> Vector3d {
    return a * (to - from) + 0.5 * b * (to * to - from * from);
  };
  Eigen::Quaterniond fine = Eigen::Quaterniond::Identity();
  for (int i = 0; i < 10000; ++i) {
    fine = fine * geodesy::from_rotation_vector(rotation(7e-7 * i, 7e-7 * (i + 1)));
  }
  const Increment previous{rotation(-0.003, 0.0), Vector3d::Zero(), 0.003},
      now{rotation(0.0, 0.007), Vector3d::Zero(), 0.007};
  const Vector3d truth = geodesy::to_rotation_vector(fine);
  EXPECT_LT((with_coning_and_sculling(previous, now).rotation - truth).norm(), 1e-4 * (now.rotation - truth).norm());
}

RC_GTEST_PROP(Mechanization, SplittingAnIntervalChangesNothing, ()) {
  const auto real = [](double lo, double hi) { return lo + (hi - lo) * 1e-6 * *rc::gen::inRange(0, 1000001); };
  NavState s;
  s.position = {real(-1.3, 1.3), real(-3, 3), real(-100, 3000)};
  s.v_eb_n = {real(-80, 80), real(-80, 80), real(-5, 5)};
  s.q_nb = geodesy::to_quaternion(geodesy::Euler{real(-1, 1), real(-1, 1), real(-3, 3)});
  const Increment whole{
      {real(-.02, .02), real(-.02, .02), real(-.02, .02)}, {real(-.1, .1), real(-.1, .1), real(-.1, .1)}, 0.01};
  const double share = real(0.01, 0.99);
  const NavState once = mechanize(s, whole);
  const NavState twice = mechanize(mechanize(s, part(whole, share)), part(whole, 1.0 - share));
  const Difference d = difference(once, twice);
  // Specific force is constant in b while b turns: only that curvature of the path, of third order, is left.
  RC_ASSERT(d.position.norm() < 1e-5);
  RC_ASSERT(d.velocity.norm() < 1e-8);
  RC_ASSERT(d.attitude.norm() < 1e-11);
}

TEST(Mechanization, UnixNanosecondsLoseNothing) {
  // The same recording with its clock at 0 and at 1.7e9 s: identical to the last bit.
  test::Motion m{.speed = 5.0, .swing = 2.0, .turn = 0.5};
  const test::Recording late = test::record(m, 20.0);
  test::Recording early = late;
  for (auto& s : early.imu.samples) s.time.ns -= m.epoch.ns;
  early.truth.front().time.ns = 0;
  const NavState a = integrate(late.truth.front(), late.imu).back(),
                 b = integrate(early.truth.front(), early.imu).back();
  EXPECT_EQ(a.position, b.position);
}

TEST(Mechanization, CorrectionUndoesTheSensorModel) {
  const ImuCorrection c{{1e-3, -2e-3, 3e-3}, {0.1, -0.2, 0.3}, {1e-3, 2e-3, -3e-3}, {-1e-3, 5e-4, 2e-3}};
  const Vector3d omega(0.1, 0.2, -0.3), f(1.0, 2.0, -9.8);
  const double dt = 0.005;
  sensors::ImuSample sample;
  sample.dtheta = (omega.cwiseProduct(Vector3d::Ones() + c.gyro_scale) + c.gyro_bias) * dt;
  sample.dvel = (f.cwiseProduct(Vector3d::Ones() + c.accelerometer_scale) + c.accelerometer_bias) * dt;
  const Increment i = corrected(sample, dt, c);
  EXPECT_LT((i.rotation - omega * dt).norm(), 1e-17);
  EXPECT_LT((i.velocity - f * dt).norm(), 1e-16);
}

}  // namespace
}  // namespace versine::inertial
