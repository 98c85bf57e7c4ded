// SPDX-License-Identifier: Apache-2.0
#include "versine/track/fastenings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "versine/track/versine.hpp"

namespace versine::track {
namespace {

/// Every combination of steps of six fastenings.
TEST(Fastenings, FewestMovedThenLeastMovementAsBruteForceFinds) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> error(-2.4e-3, 2.4e-3);
  FasteningOptions o;
  o.lowest = -2e-3;
  o.highest = 2e-3;
  o.deviation_limit = 1.6e-3;
  o.difference_limit = 1e-3;
  o.checks = {{"short", 1.8, 0.6, 0.6}};
  o.check_limits = {1.2e-3};
  std::vector<double> position;
  for (int i = 0; i < 6; ++i) position.push_back(0.6 * i);
  for (int round = 0; round < 8; ++round) {
    std::vector<double> e, other;
    for (int i = 0; i < 6; ++i) e.push_back(error(random)), other.push_back(0.3 * error(random));
    double best = 1e300;
    std::vector<int> k(6, -2);
    for (int code = 0; code < 15625; ++code) {
      int rest = code, moved = 0, total = 0;
      bool good = true;
      std::vector<double> after(6);
      for (std::size_t i = 0; i < 6; ++i, rest /= 5) {
        k[i] = rest % 5 - 2;
        moved += k[i] != 0;
        total += std::abs(k[i]);
        after[i] = e[i] + 1e-3 * k[i];
        good = good && std::abs(after[i]) <= o.deviation_limit && std::abs(after[i] - other[i]) <= o.difference_limit;
        if (i > 0) good = good && std::abs(k[i] - k[i - 1]) <= 2;
      }
      for (std::size_t i = 1; i + 2 < 6 && good; ++i) {
        const double d = after[i] - after[i + 1] + (after[i + 2] - after[i - 1]) / 3.0;
        good = std::abs(d) <= 1.2e-3;
      }
      if (good) best = std::min(best, moved + 0.01 * total);
    }
    const auto plan = plan_fastenings(position, e, o, other);
    ASSERT_TRUE(plan) << plan.error().message();
    if (best > 1e299) {
      EXPECT_GT(plan->unreachable, 0u) << round;
      continue;
    }
    EXPECT_EQ(plan->unreachable, 0u) << round;
    int total = 0;
    for (const int s : plan->steps) total += std::abs(s);
    EXPECT_NEAR(double(plan->moved) + 0.01 * total, best, 0.009) << round;
  }
}

TEST(Fastenings, ALongRailMeetsItsLimitsInWindows) {
  FasteningOptions o;
  std::vector<double> position, e;
  for (int i = 0; i < 400; ++i) {
    const double s = 0.63 * i;
    position.push_back(s);
    e.push_back(3e-3 * std::exp(-std::pow((s - 90.0) / 4.0, 2)) + 0.8e-3 * std::sin(s / 6.0));
  }
  e[300] = std::nan("");
  const auto plan = plan_fastenings(position, e, o);
  ASSERT_TRUE(plan) << plan.error().message();
  EXPECT_EQ(plan->unreachable, 0u);
  EXPECT_GT(plan->moved, 0u);
  EXPECT_LT(plan->moved, 60u);
  EXPECT_EQ(plan->steps[300], 0);
  o.check_limits.clear();
  EXPECT_FALSE(plan_fastenings(position, e, o));
}

}  // namespace
}  // namespace versine::track
