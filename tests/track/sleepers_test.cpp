// SPDX-License-Identifier: Apache-2.0
#include "versine/track/sleepers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace versine::track {
namespace {

TEST(Sleepers, MissedOnesAreMendedAndFalseOnesRejected) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise(0.0, 0.002), jitter(0.0, 0.005);
  std::vector<double> truth, missed, wrong;
  for (int i = 0; i < 500; ++i) {
    truth.push_back(1.0 + 0.6 * i + jitter(random));
    if (i % 37 == 20) missed.push_back(truth.back());
    if (i % 53 == 10) wrong.push_back(truth.back() + 0.3);
  }
  std::vector<double> s, range;
  for (double x = 0; x < 302; x += 0.02) {
    bool over = false;
    for (const double t : truth) over |= std::abs(x - t) < 0.125;
    for (const double t : missed) over &= !(std::abs(x - t) < 0.14);
    for (const double t : wrong) over |= std::abs(x - t) < 0.06;
    s.push_back(x);
    range.push_back((over ? 0.22 : 0.30) + noise(random));
  }
  const auto r = find_sleepers(s, range);
  ASSERT_EQ(r.sleepers.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i)
    EXPECT_NEAR(r.sleepers[i].mileage, truth[i], r.sleepers[i].mended ? 0.03 : 0.015);
  EXPECT_EQ(r.mended, missed.size());
  EXPECT_EQ(r.rejected, wrong.size());
}

}  // namespace
}  // namespace versine::track
