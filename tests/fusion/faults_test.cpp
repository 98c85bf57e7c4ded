// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>

#include "fusion/run.hpp"
#include "versine/filter/consistency.hpp"
#include "versine/sensors/imu_check.hpp"

/// Faults of a recording that other programs answer with wrong numbers: each in twenty runs, looked at each second from
/// the fault on, each axis by itself. Three statements hold of errors that are those of the sigmas:
/// - at least 99 % of them within three sigma (99.73 % are expected; neighbouring errors are alike, so the share
/// varies),
/// - their mean square within the 99 % bounds of chi-square, with one point counted for each run: the worst case, all
///   points of a run alike,
/// - none beyond 4.5 sigma (a chance of 1 % in the 1200 to 1800 looks if all were independent, less if they are not).
namespace versine::fusion {
namespace {
using test::Scenario;
using test::Simulated;

constexpr unsigned runs = 20;
constexpr double fault_at = 40.0;  // s

Scenario ride() {
  Scenario s{.duration = 60.0, .rate = 100.0};
  s.motion.still = 10.0;
  return s;
}

struct Outcome {
  std::size_t within = 0, looked_at = 0;
  double squares = 0.0, worst_sigmas = 0.0, worst_position = 0.0;

  void look(const Eigen::Vector3d& error, const Eigen::Vector3d& sigma) {
    for (const double x : error.cwiseAbs().cwiseQuotient(sigma)) {
      within += x <= 3.0 ? 1 : 0;
      ++looked_at;
      squares += x * x;
      if (!(x <= worst_sigmas)) worst_sigmas = x;  // a NaN stays
    }
    if (!(error.norm() <= worst_position)) worst_position = error.norm();
  }
};

Outcome after(const Scenario& s, double from, const std::function<void(Simulated&, AidedInsResult*)>& fault) {
  Outcome o;
  for (unsigned seed = 100; seed < 100 + runs; ++seed) {
    Simulated run = test::make(s, seed);
    run.options.output_rate = 1.0;
    run.options.zero_velocity_sigma = 0.002;
    fault(run, nullptr);
    AidedInsResult r = test::solve(run);
    fault(run, &r);
    for (const auto& p : r.solution.smoothed) {
      const double t = (p.time - s.motion.epoch).seconds();
      if (t < from || t > s.duration - 1.0) continue;
      o.look(test::error_of(s, run, p).position, p.position_covariance.matrix().diagonal().cwiseSqrt());
    }
  }
  EXPECT_GE(o.looked_at, 3U * runs * 15U);
  EXPECT_GE(static_cast<double>(o.within), 0.99 * static_cast<double>(o.looked_at));
  const filter::Bounds bounds = filter::mean_chi_square_bounds(runs, 3.0, 0.99);
  const double mean = o.squares / static_cast<double>(o.looked_at);
  EXPECT_GT(mean, bounds.lower);
  EXPECT_LT(mean, bounds.upper);
  EXPECT_LT(o.worst_sigmas, 4.5);
  return o;
}

TEST(AidedInsFaults, GapOfTwoSecondsStartsASegment) {
  const Outcome o = after(ride(), fault_at, [](Simulated& run, AidedInsResult* r) {
    if (r != nullptr) {
      EXPECT_EQ(r->segments.size(), 2U);
      EXPECT_EQ(r->solution.smoothed.samples.back().segment, 1);
      return;
    }
    auto& imu = run.input.imu.samples;
    imu.erase(imu.begin() + 4000, imu.begin() + 4200);
  });
  EXPECT_LT(o.worst_position, 0.2);
}

TEST(AidedInsFaults, FiveOutliersAreRejectedAndRecorded) {
  const Outcome o = after(ride(), fault_at - 2.0, [](Simulated& run, AidedInsResult* r) {
    if (r == nullptr) {
      for (std::size_t i = 40; i < 45; ++i) {
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
  const Outcome o = after(ride(), fault_at, [](Simulated& run, AidedInsResult* r) {
    if (r != nullptr) return;
    auto& imu = run.input.imu.samples;
    imu.insert(imu.begin() + 4000, imu[4000]);
    auto checked = sensors::check_imu(run.input.imu);
    ASSERT_TRUE(checked) << checked.error().message();
    EXPECT_FALSE(checked->record.findings.empty());
    run.input.imu = checked->series;
  });
  EXPECT_LT(o.worst_position, 0.1);
}

TEST(AidedInsFaults, NanSampleIsBridgedByTheCheck) {
  const Outcome o = after(ride(), fault_at, [](Simulated& run, AidedInsResult* r) {
    if (r != nullptr) return;
    run.input.imu.samples[4000].dtheta.y() = std::nan("");
    auto checked = sensors::check_imu(run.input.imu);
    ASSERT_TRUE(checked) << checked.error().message();
    EXPECT_FALSE(checked->record.findings.empty());
    run.input.imu = checked->series;
  });
  EXPECT_LT(o.worst_position, 0.1);
}

TEST(AidedInsFaults, NanFixIsRejected) {
  after(ride(), fault_at, [](Simulated& run, AidedInsResult* r) {
    if (r == nullptr) {
      run.input.gnss[40].position.height = std::nan("");
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
  const Outcome o = after(ride(), fault_at, [](Simulated& run, AidedInsResult* r) {
    if (r == nullptr) {
      for (auto& x : run.input.odometer.samples) {
        if ((x.time - run.truth.truth[0].time).seconds() > fault_at) x.distance += 0.4;
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
