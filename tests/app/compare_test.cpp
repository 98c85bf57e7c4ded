// SPDX-License-Identifier: Apache-2.0
#include "versine/app/compare.hpp"

#include <gtest/gtest.h>

#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::app {
namespace {

/// A circle of 100 m radius at 10 m/s, sampled at `rate`, moved by `offset` across (to the right) and up.
geodesy::Trajectory circle(double rate, double right = 0.0, double up = 0.0) {
  geodesy::Trajectory out;
  const geodesy::Geodetic centre{0.8, 0.2, 100.0};
  for (int k = 0; k <= static_cast<int>(20 * rate); ++k) {
    const double t = k / rate, angle = 0.1 * t;
    geodesy::TrajectoryPoint p;
    p.time = Time::from_seconds(t);
    const double radius = 100.0 - right;  // clockwise: the centre is on the right
    p.position = geodesy::wgs84.displaced(centre, {radius * std::sin(angle), -radius * std::cos(angle), -up});
    p.v_eb_n = {10 * std::cos(angle), 10 * std::sin(angle), 0};
    p.q_nb = geodesy::to_quaternion({0, 0, angle});
    p.position_covariance = geodesy::Covariance3::from(1e-4 * Eigen::Matrix3d::Identity());
    out.samples.push_back(p);
  }
  return out;
}

TEST(CompareTrajectories, OffsetsComeBackInTrackAxes) {
  const auto c = compare_trajectories(circle(10, 0.02, -0.03), circle(10));
  ASSERT_TRUE(c);
  EXPECT_NEAR(c->across.rms, 0.02, 1e-6);
  EXPECT_NEAR(c->up.rms, 0.03, 1e-6);
  EXPECT_NEAR(c->along.rms, 0.0, 1e-5);
  EXPECT_EQ(c->across.coverage, 1.0);  // sigma 14 mm both together: 20 mm inside, 30 mm outside
  EXPECT_EQ(c->up.coverage, 0.0);
}

TEST(CompareTrajectories, InterpolationFollowsTheCurve) {
  const auto c = compare_trajectories(circle(1), circle(7));
  ASSERT_TRUE(c);
  EXPECT_LT(c->across.max, 1e-3);  // linear interpolation would be 0.12 m off
}

TEST(CompareTrajectories, SaysWhenNothingOverlaps) {
  auto late = circle(1);
  for (auto& p : late.samples) p.time = p.time + Duration::from_seconds(100);
  EXPECT_FALSE(compare_trajectories(late, circle(1)));
}

}  // namespace
}  // namespace versine::app
