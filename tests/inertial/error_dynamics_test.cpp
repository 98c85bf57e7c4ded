// SPDX-License-Identifier: Apache-2.0
#include "versine/inertial/error_dynamics.hpp"

#include <gtest/gtest.h>

#include "inertial/synthetic_motion.hpp"

namespace versine::inertial {
namespace {
using Error = Eigen::Matrix<double, 21, 1>;

/// Integrates with initial errors and sensor errors, and returns the errors at the end.
Eigen::Matrix<double, 9, 1> grown(const test::Recording& r, const Error& x) {
  NavState start = r.truth.front();
  start.position = geodesy::wgs84.displaced(start.position, x.head<3>());
  start.v_eb_n += x.segment<3>(3);
  start.q_nb = geodesy::from_rotation_vector(-x.segment<3>(6)) * start.q_nb;
  // What is left in the corrected output is x: the correction takes off too little by it.
  const ImuCorrection c{-x.segment<3>(9), -x.segment<3>(12), -x.segment<3>(15), -x.segment<3>(18)};
  const NavState end = integrate(start, r.imu, c).back(), clean = integrate(r.truth.front(), r.imu).back();
  Eigen::Matrix<double, 9, 1> e;
  e << geodesy::wgs84.ned_difference(clean.position, end.position), end.v_eb_n - clean.v_eb_n,
      geodesy::to_rotation_vector(clean.q_nb * end.q_nb.conjugate());
  return e;
}

TEST(ErrorDynamics, AccumulatedTransitionMatchesPerturbation) {
  const test::Recording r =
      test::record({.speed = 20.0, .swing = 5.0, .turn = 1.0, .climb = 0.05, .roll = 0.1, .period = 20.0}, 5.0);
  TransitionAccumulator accumulated;
  NavState s = r.truth.front();
  Eigen::Matrix3d C_nb = s.q_nb.toRotationMatrix();
  StepGeometry g;
  for (const auto& sample : r.imu.samples) {
    const Increment i = corrected(sample, 0.005, {});
    s = mechanize(s, i, geodesy::wgs84, C_nb, g);
    accumulated.add(g, i);
  }
  Eigen::Matrix<double, 9, 21> phi;
  phi << accumulated.navigation(), accumulated.sensors();
  const double step[7] = {10.0, 1e-2, 1e-4, 1e-5, 1e-3, 1e-4, 1e-4};
  for (int j = 0; j < 21; ++j) {
    Error x = Error::Zero();
    x[j] = step[j / 3];
    const Eigen::Matrix<double, 9, 1> numeric = (grown(r, x) - grown(r, -x)) / (2.0 * x[j]);
    for (int b = 0; b < 9; b += 3) {
      const double scale = std::max(phi.block<3, 1>(b, j).norm(), 1e-9);
      EXPECT_LT((numeric.segment<3>(b) - phi.block<3, 1>(b, j)).norm(), 2e-3 * scale + 1e-7)
          << "rows " << b << " column " << j;
    }
  }
}

TEST(ErrorDynamics, TransitionOfAShortTimeIsIPlusFdt) {
  test::Motion m{.speed = 20.0, .swing = 5.0, .turn = 1.0, .climb = 0.05, .roll = 0.1};
  const test::Recording r = test::record(m, 0.01, 1000.0);
  NavState s = r.truth[4];
  Eigen::Matrix3d C_nb = s.q_nb.toRotationMatrix();
  StepGeometry g;
  const Increment i = corrected(r.imu[4], 0.001, {});
  TransitionAccumulator phi;
  const NavState before = s;
  s = mechanize(s, i, geodesy::wgs84, C_nb, g);
  phi.add(g, i);
  const ErrorDynamics f = error_dynamics(before, i.velocity / i.dt, i.rotation / i.dt);
  EXPECT_LT((phi.navigation() - Eigen::Matrix<double, 9, 9>::Identity() - f.navigation * i.dt).norm(), 2e-5);
  EXPECT_LT((phi.sensors() - f.sensors * i.dt).norm(), 2e-5);
}

}  // namespace
}  // namespace versine::inertial
