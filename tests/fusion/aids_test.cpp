// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "fusion/run.hpp"
#include "versine/filter/consistency.hpp"

/// Aids and weights that the main tests of the aided INS do not use.
namespace versine::fusion {
namespace {
using test::Scenario;
using test::Simulated;

TEST(AidedInsAids, SpeedCarriesThroughAnOutageWhereThereIsNoOdometer) {
  Scenario s{.duration = 110.0};
  s.wheel_lever.setZero();
  Simulated run = test::make(s, 21);
  run.input.odometer.samples.clear();
  std::erase_if(run.input.gnss.samples, [&](const auto& g) {
    const double t = (g.time - s.motion.epoch).seconds();
    return t > 60 && t < 100;
  });
  run.options.output_rate = 10.0;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (double t = 0.2; t < s.duration; t += 0.2) {
    run.input.speed.samples.push_back({s.motion.epoch + Duration::from_seconds(t),
                                       (1.0 + s.odometer_scale) * s.motion.forward(t) + 0.02 * normal(random)});
  }
  run.options.speed_sigma = 0.02;
  const AidedInsResult r = test::solve(run);
  const test::Worst with = test::worst_between(s, run, r, 60, 100);
  EXPECT_LT(with.position, 0.15);
  EXPECT_LT(with.sigmas, 4.0);
  const auto& end = r.solution.sensor_errors.back();
  EXPECT_NEAR(end.value[12], s.odometer_scale, 4.0 * double(end.sigma[12]));
}

TEST(AidedInsAids, HeadingSamplesHoldTheHeadingOfAStandingVehicle) {
  Scenario s{.duration = 60.0};
  s.motion.still = 60.0;
  Simulated run = test::make(s, 22);
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  for (double t = 1.0; t < s.duration; t += 1.0) {
    run.input.heading.samples.push_back(
        {s.motion.epoch + Duration::from_seconds(t), 0.5 + 2e-3 * normal(random), 2e-3});
  }
  const AidedInsResult r = test::solve(run);
  const auto& p = r.solution.smoothed.samples[6000];
  const double sigma = std::sqrt(double(p.attitude_covariance.zz));
  EXPECT_LT(sigma, 6e-4);
  EXPECT_LT(std::abs(test::error_of(s, run, p).attitude.z()), 4.0 * sigma);
}

TEST(AidedInsAids, HuberWeightsTakeTheEdgeOffLongTails) {
  // One fix in ten is ten times as wrong as told; gates wide open, so that only the weights act.
  double plain = 0.0, robust = 0.0;
  for (unsigned seed = 0; seed < 4; ++seed) {
    Scenario s{.duration = 60.0};
    Simulated run = test::make(s, 40 + seed);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    for (std::size_t i = 5; i < run.input.gnss.size(); i += 10) {
      run.input.gnss[i].position = geodesy::wgs84.displaced(
          run.input.gnss[i].position, 0.2 * Eigen::Vector3d(normal(random), normal(random), normal(random)));
    }
    run.options.gate_probability = 1e-300;
    run.options.output_rate = 10.0;
    plain += test::worst_between(s, run, test::solve(run), 10, 60).position;
    run.options.robust = RobustWeight::huber;
    robust += test::worst_between(s, run, test::solve(run), 10, 60).position;
  }
  EXPECT_LT(robust, 0.8 * plain);
}

TEST(AidedInsAids, SlowGnssErrorIsEstimated) {
  // Errors of a receiver that are the same for minutes: taken as white they make sigmas that do not cover them.
  const auto run_with = [](double sigma) {
    double total = 0.0;
    const int runs = 30;
    for (unsigned seed = 0; seed < unsigned(runs); ++seed) {
      Scenario s{.duration = 100.0, .rate = 50.0};
      s.motion.still = 10.0;
      Simulated run = test::make(s, 300 + seed);
      std::mt19937_64 random(seed);
      std::normal_distribution<double> normal;
      Eigen::Vector3d slow(normal(random), normal(random), normal(random));
      const double decay = std::exp(-1.0 / 60.0);
      for (auto& g : run.input.gnss.samples) {
        g.position = geodesy::wgs84.displaced(g.position, 0.02 * slow);
        g.sigma_ned.setConstant(sigma > 0.0 ? 0.02 : 0.02 * std::sqrt(2.0));
        slow = decay * slow +
               std::sqrt(1.0 - decay * decay) * Eigen::Vector3d(normal(random), normal(random), normal(random));
      }
      run.options.gnss_bias = sigma;
      run.options.gnss_bias_time = 60.0;
      run.options.output_rate = 10.0;
      total += test::nees(s, run, test::solve(run).solution.smoothed.samples[600]).position / 3.0;
    }
    return total / runs;
  };
  const filter::Bounds b = filter::mean_chi_square_bounds(30, 3.0, 0.999);
  EXPECT_GT(run_with(0.0), 1.5 * b.upper);
  const double with = run_with(0.02);
  EXPECT_GT(with, b.lower);
  EXPECT_LT(with, b.upper);
}

}  // namespace
}  // namespace versine::fusion
