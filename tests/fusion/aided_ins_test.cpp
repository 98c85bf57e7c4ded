// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/aided_ins.hpp"

#include <gtest/gtest.h>

#include "fusion/run.hpp"

namespace versine::fusion {
namespace {
using test::Scenario;
using test::Simulated;

using test::solve;

/// Largest error in sigmas (position, over all points), and whether everything is finite.
double worst_ratio(const Scenario& s, const Simulated& run, const AidedInsResult& r, double* worst_position = nullptr) {
  double worst = 0.0, position = 0.0;
  for (std::size_t i = 0; i < r.solution.smoothed.size(); i += 20) {
    const auto& p = r.solution.smoothed[i];
    const auto e = test::error_at(p, test::truth_at(s, run.truth, (p.time - s.motion.epoch).seconds()));
    const double ratio = std::sqrt(e.position.dot(p.position_covariance.matrix().inverse() * e.position));
    if (!(ratio <= worst)) worst = ratio;
    position = std::max(position, e.position.norm());
  }
  if (worst_position != nullptr) *worst_position = position;
  return worst;
}

TEST(AidedIns, ErrorFreeMeasurementsGiveTheTruth) {
  Scenario s{.noise = false};
  Simulated run = test::make(s, 1);
  run.options.initial_heading = 0.5;
  const AidedInsResult r = solve(run);
  ASSERT_EQ(r.solution.smoothed.size(), run.input.imu.size());
  EXPECT_TRUE(r.solution.record.rejections.empty());
  ASSERT_FALSE(r.standstills.empty());
  for (std::size_t i = 0; i < r.solution.smoothed.size(); i += 50) {
    const auto& p = r.solution.smoothed[i];
    const auto e = test::error_at(p, test::truth_at(s, run.truth, (p.time - s.motion.epoch).seconds()));
    ASSERT_LT(e.position.norm(), 2e-3) << i;
    ASSERT_LT(e.attitude.norm(), 3e-4) << i;
  }
}

void expect_smoothers_agree(double wander) {
  Scenario s;
  s.wheel_lever.setZero();
  Simulated run = test::make(s, 2);
  run.options.mounting_sigma = 0.01;
  run.options.constraint = true;
  run.options.constraint_wander = wander;
  run.options.output_rate = 10.0;
  run.options.chain_rate = 1.0;
  const AidedInsResult a = solve(run);
  run.options.smoother = SmootherKind::rauch_tung_striebel;
  const AidedInsResult b = solve(run);
  ASSERT_EQ(a.smoother_used, SmootherKind::bryson_frazier);
  ASSERT_EQ(a.solution.smoothed.size(), b.solution.smoothed.size());
  for (std::size_t i = 0; i < a.solution.smoothed.size(); ++i) {
    const auto &p = a.solution.smoothed[i], &q = b.solution.smoothed[i];
    const double sigma = std::sqrt(p.position_covariance.matrix().trace());
    ASSERT_LT(geodesy::wgs84.ned_difference(p.position, q.position).norm(), 0.01 * sigma) << i;
    ASSERT_NEAR(p.position_covariance.xx / q.position_covariance.xx, 1.0, 0.01) << i;
    ASSERT_NEAR(p.attitude_covariance.zz / q.attitude_covariance.zz, 1.0, 0.01) << i;
  }
  ASSERT_EQ(a.solution.chain.size(), b.solution.chain.size());
  const auto ca = a.solution.chain.cross_covariance(20, 23), cb = b.solution.chain.cross_covariance(20, 23);
  EXPECT_LT((ca - cb).norm(), 0.01 * ca.norm());
}

TEST(AidedIns, BothSmoothersAgree) {
  expect_smoothers_agree(0.0);
  expect_smoothers_agree(1e-3);
}

TEST(AidedIns, SmoothedVariancesAreNeverAboveTheFilters) {
  Simulated run = test::make({}, 3);
  run.options.keep_forward = true;
  run.options.output_rate = 10.0;
  const AidedInsResult r = solve(run);
  ASSERT_EQ(r.solution.smoothed.size(), r.solution.forward.size());
  for (std::size_t i = 0; i < r.solution.smoothed.size(); ++i) {
    const auto &s = r.solution.smoothed[i], &f = r.solution.forward[i];
    for (const auto& [a, b] : {std::pair{s.position_covariance, f.position_covariance},
                               {s.velocity_covariance, f.velocity_covariance},
                               {s.attitude_covariance, f.attitude_covariance}}) {
      ASSERT_LE(a.xx, b.xx * 1.0001f) << i;
      ASSERT_LE(a.yy, b.yy * 1.0001f) << i;
      ASSERT_LE(a.zz, b.zz * 1.0001f) << i;
    }
  }
}

Scenario with_wheels() {
  Scenario s;
  s.wheel_lever.setZero();
  s.duration = 160.0;
  return s;
}

/// A minute without fixes.
Simulated with_outage(const Scenario& s) {
  Simulated run = test::make(s, 9);
  run.options.constraint = true;
  std::erase_if(run.input.gnss.samples, [&](const auto& g) {
    const double t = (g.time - s.motion.epoch).seconds();
    return t > 80 && t < 140;
  });
  return run;
}

TEST(AidedIns, OutageIsBridgedByOdometerAndConstraint) {
  const Scenario s = with_wheels();
  Simulated run = with_outage(s);
  const AidedInsResult r = solve(run);
  double with = 0, without = 0;
  EXPECT_LT(worst_ratio(s, run, r, &with), 4.5);
  const float scale = r.solution.sensor_errors.back().value[12];
  EXPECT_EQ(r.solution.error_names[12], "odometer_scale");
  EXPECT_NEAR(scale, s.odometer_scale, 4.0 * double(r.solution.sensor_errors.back().sigma[12]));
  run.options.constraint = false;
  run.input.odometer.samples.clear();
  EXPECT_LT(worst_ratio(s, run, solve(run), &without), 4.5);
  EXPECT_LT(with, 0.3 * without);
  EXPECT_LT(with, 0.25);
}

TEST(AidedIns, WheelsThatNeverStrayFarHoldTheWay) {
  // The sum of their way tells more than velocities whose errors would add up.
  const Scenario s = with_wheels();
  Simulated run = with_outage(s);
  double velocity = 0.0, path = 0.0;
  worst_ratio(s, run, solve(run), &velocity);
  run.options.constraint_angle = 1e-6;
  run.options.constraint_sigma = 1e-5;
  run.options.constraint_wander = 1e-4;
  const AidedInsResult r = solve(run);
  EXPECT_TRUE(r.solution.record.rejections.empty());
  EXPECT_LT(worst_ratio(s, run, r, &path), 4.5);
  EXPECT_LT(path, velocity);
}

TEST(AidedIns, CourseGivesTheHeading) {
  Scenario s;
  Simulated run = test::make(s, 10);
  run.options.heading_source = HeadingSource::automatic;
  run.options.initial_heading.reset();
  const AidedInsResult r = solve(run);
  EXPECT_EQ(r.segments[0].alignment.method, "course");
  EXPECT_NEAR(geodesy::to_euler(r.segments[0].alignment.q_nb).yaw, 0.5, 4.0 * r.segments[0].alignment.sigma.z());
  EXPECT_LT(worst_ratio(s, run, r), 4.5);
}

TEST(AidedIns, GyrocompassIsRefinedByTheFilter) {
  Scenario s{.errors = sensors::find_imu_grade("navigation-rlg")->errors};
  s.motion.still = 200.0;
  s.duration = 220.0;
  s.rate = 100.0;
  Simulated run = test::make(s, 11);
  run.options.heading_source = HeadingSource::gyrocompass;
  const AidedInsResult r = solve(run);
  ASSERT_TRUE(r.segments[0].fine_sigma.has_value());
  const double sigma = r.segments[0].fine_sigma->z();
  EXPECT_LT(sigma, 0.15 * units::deg);
  EXPECT_LT(std::abs(r.segments[0].fine_attitude->yaw - 0.5), 4.0 * sigma);
}

TEST(AidedIns, DeadReckoningFollowsTheSmoothedWay) {
  Scenario s;
  Simulated run = test::make(s, 12);
  run.options.dead_reckoning = true;
  const AidedInsResult r = solve(run);
  ASSERT_TRUE(r.dead_reckoned.has_value());
  const auto& p = r.dead_reckoned->samples.back();
  const auto e = test::error_at(p, test::truth_at(s, run.truth, (p.time - s.motion.epoch).seconds()));
  EXPECT_LT(e.position.norm(), 1.5);  // 700 m of way, heading known to about 1 mrad
}

TEST(AidedIns, NothingThatTellsPositionIsAnError) {
  Simulated run = test::make({.duration = 10.0}, 13);
  run.input.gnss.samples.clear();
  SilentProgress progress;
  SilentLog log;
  const auto r = run_aided_ins(run.input, run.options, progress, log);
  ASSERT_FALSE(r);
  EXPECT_NE(r.error().advice.find("initial position"), std::string::npos);
}

}  // namespace
}  // namespace versine::fusion
