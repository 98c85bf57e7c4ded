// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>

#include "fusion/run.hpp"
#include "versine/sensors/imu_check.hpp"

/// Faults of a recording that other programs answer with wrong numbers: each in several runs, the error from the fault
/// on against three sigma of each axis. Of the many points looked at a few are beyond three sigma by chance (1 %
/// for three axes, and in streaks, because neighbouring errors are alike): few may be, and the worst stays near.
namespace versine::fusion {
namespace {
using test::Scenario;
using test::Simulated;

struct Outcome {
  int beyond = 0, looked_at = 0;
  double worst_sigmas = 0.0, worst_position = 0.0;
};

/// Six runs with the fault, looked at each second from `from` on, and at every axis.
Outcome after(const Scenario& s, double from, const std::function<void(Simulated&, AidedInsResult*)>& fault) {
  Outcome o;
  for (unsigned seed = 100; seed < 106; ++seed) {
    Simulated run = test::make(s, seed);
    run.options.output_rate = 10.0;
    run.options.zero_velocity_sigma = 0.002;
    fault(run, nullptr);
    AidedInsResult r = test::solve(run);
    fault(run, &r);
    for (double t = from; t < s.duration - 1.0; t += 1.0) {
      const test::Worst w = test::worst_between(s, run, r, t, t + 0.05);
      o.beyond += w.sigmas <= 3.0 ? 0 : 1;
      ++o.looked_at;
      if (!(w.sigmas <= o.worst_sigmas)) o.worst_sigmas = w.sigmas;
      if (!(w.position <= o.worst_position)) o.worst_position = w.position;
    }
  }
  EXPECT_LE(o.beyond, 0.08 * o.looked_at);
  EXPECT_LT(o.worst_sigmas, 4.5);
  return o;
}

TEST(AidedInsFaults, GapOfTwoSecondsStartsASegment) {
  const Outcome o = after({.duration = 100.0}, 70.0, [](Simulated& run, AidedInsResult* r) {
    if (r != nullptr) {
      EXPECT_EQ(r->segments.size(), 2U);
      EXPECT_EQ(r->solution.smoothed.samples.back().segment, 1);
      return;
    }
    auto& imu = run.input.imu.samples;
    imu.erase(imu.begin() + 14000, imu.begin() + 14400);
  });
  EXPECT_LT(o.worst_position, 0.2);
}

TEST(AidedInsFaults, FiveOutliersAreRejectedAndRecorded) {
  const Outcome o = after({.duration = 100.0}, 58.0, [](Simulated& run, AidedInsResult* r) {
    if (r == nullptr) {
      for (std::size_t i = 60; i < 65; ++i) {
        run.input.gnss[i].position = geodesy::wgs84.displaced(run.input.gnss[i].position, {1.5, 1.6, 0.0});
      }
      return;
    }
    int rejected = 0;
    for (const Rejection& x : r->solution.record.rejections) rejected += x.sensor == "gnss position" ? 1 : 0;
    EXPECT_EQ(rejected, 5);
  });
  EXPECT_LT(o.worst_position, 0.1);
}

TEST(AidedInsFaults, DuplicatedLineIsDroppedByTheCheck) {
  const Outcome o = after({.duration = 80.0}, 60.0, [](Simulated& run, AidedInsResult* r) {
    if (r != nullptr) return;
    auto& imu = run.input.imu.samples;
    imu.insert(imu.begin() + 12000, imu[12000]);
    auto checked = sensors::check_imu(run.input.imu);
    ASSERT_TRUE(checked) << checked.error().message();
    EXPECT_FALSE(checked->record.findings.empty());
    run.input.imu = checked->series;
  });
  EXPECT_LT(o.worst_position, 0.1);
}

TEST(AidedInsFaults, NanSampleIsBridgedByTheCheck) {
  const Outcome o = after({.duration = 80.0}, 60.0, [](Simulated& run, AidedInsResult* r) {
    if (r != nullptr) return;
    run.input.imu.samples[12000].dtheta.y() = std::nan("");
    auto checked = sensors::check_imu(run.input.imu);
    ASSERT_TRUE(checked) << checked.error().message();
    EXPECT_FALSE(checked->record.findings.empty());
    run.input.imu = checked->series;
  });
  EXPECT_LT(o.worst_position, 0.1);
}

TEST(AidedInsFaults, NanFixIsRejected) {
  after({.duration = 80.0}, 50.0, [](Simulated& run, AidedInsResult* r) {
    if (r == nullptr) {
      run.input.gnss[50].position.height = std::nan("");
    } else {
      EXPECT_FALSE(r->solution.record.rejections.empty());
    }
  });
}

TEST(AidedInsFaults, GnssStampsOffTheEpochsByUpToHalfASampleCostNothing) {
  for (const double shift : {0.0004, 0.0009, 0.0017, 0.0025}) {
    Scenario s{.duration = 60.0, .gnss_shift = shift, .noise = false};
    s.motion.speed = 20.0;
    Simulated run = test::make(s, 7);
    run.options.initial_heading = 0.5;
    for (auto& g : run.input.gnss.samples) g.sigma_ned.setConstant(0.002);
    // 18 mm at 0.9 ms if the state were not brought to the stamp.
    EXPECT_LT(test::worst_between(s, run, test::solve(run), 0.0, 60.0).position, 2e-3) << shift;
  }
}

TEST(AidedInsFaults, OdometerThatSlipsStartsAnew) {
  const Outcome o = after({.duration = 90.0}, 60.0, [](Simulated& run, AidedInsResult* r) {
    if (r == nullptr) {
      for (auto& x : run.input.odometer.samples) {
        if ((x.time - run.truth.truth[0].time).seconds() > 60.0) x.distance += 0.4;
      }
      return;
    }
    int rejected = 0;
    for (const Rejection& x : r->solution.record.rejections) rejected += x.sensor == "odometer" ? 1 : 0;
    EXPECT_GE(rejected, 1);
    EXPECT_LE(rejected, 12);  // then its distance counts from where it stands
  });
  EXPECT_LT(o.worst_position, 0.1);
}

TEST(AidedInsFaults, WrongFixOfHalfAMinuteIsNotBelieved) {
  // A navigation-grade IMU with an odometer knows better than a wrong ambiguity that lasts; a filter that doubts itself
  // after ten rejections would jump by its metre.
  Scenario s{.duration = 150.0, .errors = sensors::find_imu_grade("navigation-rlg")->errors};
  Simulated run = test::make(s, 31);
  for (std::size_t i = 90; i < 120; ++i) {
    run.input.gnss[i].position = geodesy::wgs84.displaced(run.input.gnss[i].position, {0.6, -0.5, 0.7});
  }
  EXPECT_LT(test::worst_between(s, run, test::solve(run), 60.0, 150.0).position, 0.1);
}

}  // namespace
}  // namespace versine::fusion
