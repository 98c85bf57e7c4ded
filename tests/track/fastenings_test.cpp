// SPDX-License-Identifier: Apache-2.0
#include "versine/track/fastenings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <numbers>
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

TEST(Fastenings, HalfAKilometreOfBadSlabInBoundedTime) {
  // Waves of 7 to 90 m, a heave of 8 mm and a dip of 6 mm, readings of 0.2 mm.
  const int n = 770;
  std::vector<double> position, e;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < n; ++i) {
    const double s = 0.65 * i;
    double y = 8e-3 * std::exp(-std::pow((s - 150.0) / 5.0, 2)) - 6e-3 * std::exp(-std::pow((s - 333.0) / 3.0, 2));
    for (const double wave : {7.0, 11.0, 17.0, 25.0, 40.0, 60.0, 90.0}) {
      y += 0.12e-3 * std::sqrt(wave) * std::sin(2.0 * std::numbers::pi * s / wave + wave * wave);
    }
    position.push_back(s);
    e.push_back(y + 0.2e-3 * normal(random));
  }
  FasteningOptions o;
  o.seconds = 0.1;
  const std::clock_t begin = std::clock();
  const auto plan = plan_fastenings(position, e, o);
  const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
  ASSERT_TRUE(plan) << plan.error().message();
  // A window takes its time to search and about as much to be set up.
  EXPECT_LT(seconds, 4.0 * o.seconds * double(plan->windows));
  EXPECT_GT(plan->proven, plan->windows / 4);
  EXPECT_GE(plan->gap, 0.0);
  EXPECT_LE(plan->gap, 1.0);
  const auto over_the_check = [&](const std::vector<double>& x) {
    const auto at = [&](double s) {
      const auto k = std::min(static_cast<std::size_t>(s / 0.65), x.size() - 2);
      return x[k] + (s / 0.65 - double(k)) * (x[k + 1] - x[k]);
    };
    int over = 0;
    for (int i = 24; 0.65 * i + 15.0 < position.back(); ++i) {
      const double s = 0.65 * i;
      over += std::abs(at(s) - at(s + 5.0) + (at(s + 15.0) - at(s - 15.0)) / 6.0) > 2e-3 + 1e-6;
    }
    return over;
  };
  EXPECT_GT(over_the_check(e), 20);
  // The heave is higher than fastenings reach: beside it some checks stay over, and are told.
  EXPECT_LE(over_the_check(plan->after), 10);
  EXPECT_EQ(std::size_t(over_the_check(plan->after)), plan->unreachable);
  for (int i = 0; i < n; ++i) {
    const auto k = std::size_t(i);
    EXPECT_LE(std::abs(plan->steps[k]), 5) << "the fastening's range";
    EXPECT_DOUBLE_EQ(plan->after[k], e[k] + 1e-3 * plan->steps[k]);
    if (i > 0) {
      EXPECT_LE(std::abs(plan->steps[k] - plan->steps[k - 1]), 2);
    }
  }
}

}  // namespace
}  // namespace versine::track
