// SPDX-License-Identifier: Apache-2.0
#include "versine/app/plan.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "versine/core/units.hpp"

namespace versine::app {
namespace {
namespace fs = std::filesystem;
using namespace units;

const fs::path examples = fs::path(VERSINE_SOURCE_DIR) / "examples" / "plan";

/// The ring-laser row of Jiang 2017 section 6.1.
MonteCarloSetup ring_laser(int runs) {
  const auto config = read_plan_config(examples / "jiang_rlg.toml");
  EXPECT_TRUE(config);
  return {.plan = config->plan, .simulated_gyro = config->plan.gyro, .runs = runs};
}

/// Counts reports; cancels from the start when told to.
class Watch : public Progress {
 public:
  explicit Watch(bool cancel) : cancel_(cancel) {}
  void report(std::string_view, double fraction) override {
    ++reports;
    last = fraction;
  }
  [[nodiscard]] bool cancelled() const override { return cancel_; }
  int reports = 0;
  double last = 0.0;

 private:
  bool cancel_;
};

TEST(PlanMonteCarlo, RingLaserRowIsThePrediction) {
  SilentProgress silent;
  const auto m = run_monte_carlo(ring_laser(500), silent);
  ASSERT_TRUE(m) << m.error().message();
  EXPECT_NEAR(m->predicted.vertical / mm, 0.445, 0.0005);  // the heading error adds to the lateral gyro
  EXPECT_NEAR(m->predicted.lateral / mm, 0.440, 0.0005);
  EXPECT_NEAR(m->rms.vertical / m->predicted.vertical, 1.0, 0.05);
  EXPECT_NEAR(m->rms.lateral / m->predicted.lateral, 1.0, 0.05);
  EXPECT_NEAR(m->rms.longitudinal / m->predicted.longitudinal, 1.0, 0.05);
  for (const double inside : {m->coverage.lateral, m->coverage.vertical, m->coverage.longitudinal}) {
    EXPECT_GT(inside, 0.93);
    EXPECT_LT(inside, 0.97);
  }
  EXPECT_NEAR(m->nees, 3.0, 0.33);  // 3 sigma of 500 runs
}

TEST(PlanMonteCarlo, ChainedRunsWithAllNoisesKeepTheirPromise) {
  MonteCarloSetup setup = ring_laser(150);
  setup.plan.intervals = 3;
  setup.plan.path_walk = 0.05 * mm;
  setup.plan.distance_walk = 0.1 * mm;
  setup.plan.gyro.bias_instability = 0.01 * deg_per_hour;
  setup.simulated_gyro = setup.plan.gyro;
  setup.plan.heading = 1.0;
  SilentProgress silent;
  const auto m = run_monte_carlo(setup, silent);
  ASSERT_TRUE(m) << m.error().message();
  for (const auto& p : m->profile) {
    EXPECT_NEAR(p.rms.vertical / p.predicted.vertical, 1.0, 0.2) << p.distance;
    EXPECT_NEAR(p.rms.lateral / p.predicted.lateral, 1.0, 0.2) << p.distance;
  }
  for (const double inside : {m->coverage.lateral, m->coverage.vertical, m->coverage.longitudinal}) {
    EXPECT_GT(inside, 0.93);
    EXPECT_LT(inside, 0.97);
  }
}

TEST(PlanMonteCarlo, FlickerThatThePlanDoesNotKnowShows) {
  MonteCarloSetup setup = ring_laser(150);
  setup.flicker = true;
  setup.simulated_gyro.bias_instability = 0.3 * deg_per_hour;
  SilentProgress silent;
  const auto m = run_monte_carlo(setup, silent);
  ASSERT_TRUE(m) << m.error().message();
  EXPECT_GT(m->rms.vertical, 2.0 * m->predicted.vertical);
}

TEST(PlanMonteCarlo, ThreadsChangeNothing) {
  MonteCarloSetup setup = ring_laser(40);
  Watch one(false), four(false);
  setup.threads = 1;
  const auto a = run_monte_carlo(setup, one);
  setup.threads = 4;
  const auto b = run_monte_carlo(setup, four);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->lateral, b->lateral);
  EXPECT_EQ(a->vertical, b->vertical);
  EXPECT_EQ(a->longitudinal, b->longitudinal);
  EXPECT_EQ(a->nees, b->nees);
  EXPECT_EQ(a->coverage.lateral, b->coverage.lateral);
  EXPECT_EQ(one.reports, 40);
  EXPECT_EQ(one.last, 1.0);
}

TEST(PlanMonteCarlo, CanBeCancelled) {
  Watch watch(true);
  MonteCarloSetup setup = ring_laser(1000);
  setup.threads = 1;
  const auto m = run_monte_carlo(setup, watch);
  ASSERT_FALSE(m);
  EXPECT_EQ(m.error().found, "cancelled");
  EXPECT_EQ(watch.reports, 1);
}

TEST(Plan, Figure6BoundsAreThoseOfThePaper) {
  // Jiang section 7: bias instability under 0.1 deg/h and random walk under 0.005 deg/sqrt(h) together keep 0.67 mm;
  // section 5: an odometer whose scale walks by 11 ppm/sqrt(s) is at the limit. That is so when its scale is known at
  // the start; with 2000 ppm unknown the limit is 7.8 ppm/sqrt(s).
  auto config = read_plan_config(examples / "jiang_rlg.toml");
  ASSERT_TRUE(config);
  config->monte_carlo.runs = 0;
  SilentProgress silent;
  const auto result = compute_plan(*config, 1, silent);
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->met);
  ASSERT_TRUE(result->bias && result->random_walk && result->spacing);
  EXPECT_GT(*result->bias, 0.1 * deg_per_hour);
  EXPECT_GT(*result->random_walk, 0.005 * deg_per_sqrt_hour);
  EXPECT_GT(*result->spacing, 60.0);
  const auto sigma_at = [&](double scale, double walk) {
    fusion::LongitudinalErrors e = result->derived.longitudinal;
    e.scale = scale;
    e.scale_walk = walk;
    return std::sqrt(fusion::longitudinal_variance(e, 1.0, 60.0, 30.0));
  };
  EXPECT_LT(sigma_at(0.0, 11.0e-6), 0.67 * mm);
  EXPECT_GT(sigma_at(0.0, 11.3e-6), 0.67 * mm);
  EXPECT_LT(sigma_at(0.002, 7.7e-6), 0.67 * mm);
  EXPECT_GT(sigma_at(0.002, 7.9e-6), 0.67 * mm);
  // The map says the same as the closed form, at its corners and in its middle.
  const auto& map = result->vertical;
  const std::size_t i = 20, j = 10, n = map.x.size();
  fusion::CrossErrors e = result->derived.vertical;
  e.bias = map.x[i];
  e.random_walk = map.y[j];
  EXPECT_NEAR(map.sigma[j * n + i], std::sqrt(fusion::cross_variance(e, 1.0, 60.0, 30.0)), 1e-12);
}

}  // namespace
}  // namespace versine::app
