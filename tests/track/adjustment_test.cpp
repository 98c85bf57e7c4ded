// SPDX-License-Identifier: Apache-2.0
#include "versine/track/adjustment.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace versine::track {
namespace {

struct DippedLine {
  std::vector<double> mileage, e;
};
/// Smooth deviations with a fault of `height` at `at`.
DippedLine line_with_dip(double length, double at, double height) {
  DippedLine l;
  for (double s = 0; s <= length; s += 0.5) {
    l.mileage.push_back(s);
    const double d = (s - at) / 8.0;
    l.e.push_back(0.001 * std::sin(s / 60.0) + height * std::exp(-d * d));
  }
  return l;
}

TEST(Adjustment, BringsTheChecksWithinTheirLimitsWithLittleMovement) {
  const DippedLine l = line_with_dip(800, 400, 0.012);
  const auto a = plan_adjustment(l.mileage, l.e, 0.5, {});
  ASSERT_TRUE(a) << a.error().message();
  EXPECT_GT(a->worst_before[0], 0.004);
  EXPECT_LT(a->worst_after[0], 0.0022);
  EXPECT_LT(a->worst_after[1], 0.0105);
  EXPECT_EQ(a->movement.front(), 0.0);
  for (std::size_t i = 1; i < a->movement.size(); ++i) {
    EXPECT_LE(std::abs(a->movement[i]), 0.03 + 1e-9);
    EXPECT_LE(std::abs(a->movement[i] - a->movement[i - 1]), 0.5 * 1e-3 + 1e-9);
  }
  EXPECT_NEAR(a->movement[200], 0.0, 0.0015);  // far from the fault almost nothing moves
}

TEST(Adjustment, LiftsNeverLowerAndFixedPointsStay) {
  const DippedLine l = line_with_dip(800, 400, -0.012);
  AdjustmentOptions o;
  o.smallest = 0.0;
  o.fixed = {{200, 220}};
  const auto a = *plan_adjustment(l.mileage, l.e, 0.5, o);
  for (std::size_t i = 0; i < a.movement.size(); ++i) {
    EXPECT_GE(a.movement[i], -1e-9);
    if (l.mileage[i] >= 200 && l.mileage[i] <= 220) {
      EXPECT_NEAR(a.movement[i], 0.0, 1e-9);
    }
  }
  EXPECT_LT(a.worst_after[0], 0.0022);
}

TEST(Adjustment, ContradictingOptionsAreRefused) {
  const DippedLine l = line_with_dip(100, 50, 0.0);
  AdjustmentOptions o;
  o.smallest = 0.001;
  EXPECT_FALSE(plan_adjustment(l.mileage, l.e, 0.5, o));
}

}  // namespace
}  // namespace versine::track
