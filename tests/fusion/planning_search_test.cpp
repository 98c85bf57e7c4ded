// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/planning_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "versine/core/units.hpp"
#include "versine/fusion/planning_methods.hpp"

namespace versine::fusion {
namespace {

using namespace units;

PlanCase rlg_case() {
  PlanCase p;
  p.gyro = {.bias = 0.03 * deg_per_hour, .random_walk = 0.005 * deg_per_sqrt_hour};
  p.accelerometer = {.bias = 10e-6 * standard_gravity, .random_walk = 5e-6 * standard_gravity};
  p.level = 0.005 * deg;
  p.landmark = 0.6 * mm;
  p.latitude = 50 * deg;
  return p;
}

TEST(PlanningChain, OneIntervalIsTheClosedForm) {
  PlanCase p = rlg_case();
  p.intervals = 1;
  const auto chain = chain_accuracy(p);
  for (const auto& point : chain.profile) {
    const Directions closed = closed_form_sigma(p, point.distance);
    EXPECT_NEAR(point.sigma.lateral, closed.lateral, 1e-9);
    EXPECT_NEAR(point.sigma.vertical, closed.vertical, 1e-9);
    EXPECT_NEAR(point.sigma.longitudinal, closed.longitudinal, 1e-9);
  }
}

TEST(PlanningChain, MoreIntervalsTeachMore) {
  PlanCase p = rlg_case();
  const double alone = closed_form_worst(p).worst_cross();
  const auto chain = chain_accuracy(p);
  EXPECT_LT(chain.worst_interior.worst_cross(), alone);
  EXPECT_LT(chain.versine.lateral, 1.3 * chain.worst_interior.lateral);
  EXPECT_LT(chain.short_wave.lateral, chain.versine.lateral);
  EXPECT_GT(chain.short_wave.lateral, 0.0);
}

TEST(PlanningChain, VersineIsExactForIndependentEnds) {
  // Chord from landmark to landmark with a perfect gyro and path noise only: a Brownian bridge between tied ends.
  PlanCase p = rlg_case();
  p.gyro = {.bias = 1e-12, .random_walk = 1e-12};
  p.level = 1e-10;
  p.landmark = 1e-7;
  p.path_walk = 0.1 * mm;
  p.spacing = 30.0;
  p.intervals = 1;
  EXPECT_NEAR(chain_accuracy(p, 30.0).versine.vertical, 0.1 * mm * std::sqrt(30.0) / 2, 1e-8);
}

TEST(PlanningSearch, AnswersAreOnTheEdge) {
  for (const PlanBasis basis : {PlanBasis::interval, PlanBasis::chain}) {
    PlanCase p = rlg_case();
    const double required = 0.67 * mm;
    const auto spacing = largest_spacing(p, required, basis);
    ASSERT_TRUE(spacing);
    p.spacing = *spacing;
    EXPECT_LE(worst_sigma(p, basis), required);
    p.spacing = *spacing + 0.5;
    EXPECT_GT(worst_sigma(p, basis), required);
    p = rlg_case();
    p.gyro.random_walk = largest_random_walk(p, required, basis).value();
    EXPECT_NEAR(worst_sigma(p, basis), required, 1e-3 * required);
  }
  EXPECT_FALSE(largest_spacing(rlg_case(), 0.01 * mm, PlanBasis::interval));
}

TEST(PlanningSearch, Figure6AtItsCorner) {
  const SigmaMap map = vertical_map(rlg_case(), 0.3 * deg_per_hour, 0.03 * deg_per_sqrt_hour, 31);
  EXPECT_NEAR(map.sigma.front(), std::sqrt(cross_variance({0.6 * mm, 0.6 * mm, 0.005 * deg, 0, 0}, 1, 60, 30)), 1e-12);
  for (std::size_t i = 1; i < map.x.size(); ++i) EXPECT_GT(map.sigma[i], map.sigma[i - 1]);
}

TEST(PlanningMethods, EachSensorHelps) {
  PlanCase p = rlg_case();
  p.gyro.bias = 0.01 * deg_per_hour;
  const auto ins = method_accuracy(p, PlanMethod::ins_landmark);
  const auto aided = method_accuracy(p, PlanMethod::ins_odometer_landmark);
  const auto reckoning = method_accuracy(p, PlanMethod::landmark_reckoning);
  EXPECT_GT(ins.worst_interior.lateral, 2 * aided.worst_interior.lateral);
  // With its model right, the full filter knows at least what the reduced one knows.
  EXPECT_LT(aided.worst_interior.vertical, 1.02 * reckoning.worst_interior.vertical);
  EXPECT_LT(aided.worst_interior.lateral, 1.02 * reckoning.worst_interior.lateral);
}

}  // namespace
}  // namespace versine::fusion
