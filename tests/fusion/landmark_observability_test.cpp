// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/landmark_observability.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "versine/core/units.hpp"
#include "versine/fusion/landmark_dead_reckoning.hpp"
#include "versine/simulation/straight_run.hpp"

namespace versine::fusion {
namespace {

using namespace units;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr landmark::Prior prior{
    .position = 10.0, .scale = 0.002, .pitch = 1e-4, .heading = 3e-3, .bias = 0.03 * deg_per_hour, .roll = 5e-5};

TEST(LandmarkObservability, Equation26HasFullRankInMotionAtAnyHeading) {
  for (const double heading : {0.0, 0.4, 1.5707963, 3.0}) {
    const auto o = landmark::observability_at(1.0, heading, 60.0, prior, 0.6 * mm);
    EXPECT_EQ(o.vertical_rank, 3) << heading;
    EXPECT_EQ(o.level_rank, 5) << heading;
    EXPECT_LT(o.vertical_condition, 1e6);
    EXPECT_LT(o.level_condition, 1e6);
  }
}

TEST(LandmarkObservability, StandingStillShowsPositionOnly) {
  const auto o = landmark::observability_at(0.0, 0.4, 60.0, prior, 0.6 * mm);
  EXPECT_EQ(o.vertical_rank, 1);
  EXPECT_EQ(o.level_rank, 2);
}

TEST(LandmarkObservability, LongerIntervalsAreConditionedBetter) {
  const auto near = landmark::observability_at(1.0, 0.4, 10.0, prior, 0.6 * mm);
  const auto far = landmark::observability_at(1.0, 0.4, 60.0, prior, 0.6 * mm);
  EXPECT_GT(near.vertical_condition, 10.0 * far.vertical_condition);
}

TEST(LandmarkObservability, TwoLandmarksLeaveTheGyrosToTheirPrior) {
  simulation::StraightRun course{.latitude = 50 * deg,
                                 .heading = 0.8,
                                 .stand_first = 65.0,
                                 .stand = 10.0,
                                 .gyro = {.bias = 0.03 * deg_per_hour, .random_walk = 0.005 * deg_per_sqrt_hour},
                                 .landmark = 0.6 * mm};
  LandmarkOptions options;
  options.gyro = course.gyro;
  SilentProgress silent;
  for (const bool third : {false, true}) {
    course.spacing.assign(third ? 2 : 1, 60.0);
    const auto r = simulate_straight(course, 1);
    const auto solved = run_landmark_dead_reckoning({&r.imu, &r.odometer, &r.landmarks}, options, silent);
    ASSERT_TRUE(solved) << solved.error().message();
    const auto& o = solved->observability;
    EXPECT_EQ(o.vertical_rank, 3);
    EXPECT_EQ(o.run_vertical_rank, third ? 3 : 2);
    EXPECT_EQ(o.run_level_rank, third ? 5 : 4);
    EXPECT_THAT(o.verdict, Contains(HasSubstr(third ? "every state" : "2 landmarks determine 2 of 3 vertical")));
    EXPECT_THAT(o.verdict, Contains(HasSubstr("bias of the lateral gyro: weak")));
    EXPECT_THAT(o.verdict, Contains(HasSubstr("position is weakest")));
  }
}

}  // namespace
}  // namespace versine::fusion
