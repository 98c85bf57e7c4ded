// SPDX-License-Identifier: Apache-2.0
#include "versine/track/versine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "versine/core/numbers.hpp"
#include "versine/geodesy/local_frame.hpp"

namespace versine::track {
namespace {

using Eigen::Vector3d;

/// A left-hand arc (centre to the west of a line that heads north) on the Earth, in real metres.
std::vector<Vector3d> arc(double radius, double step, std::size_t n) {
  const geodesy::LocalFrame frame({0.85, 0.15, 300.0});
  std::vector<Vector3d> r;
  for (std::size_t i = 0; i < n; ++i) {
    const double a = step * double(i) / radius;
    r.push_back(geodesy::wgs84.to_ecef(frame.to_geodetic({radius * std::sin(a), radius * (std::cos(a) - 1.0), 0.0})).r);
  }
  return r;
}

TEST(Versine, OfACircleIsHandComputed) {
  const double R = 800.0;
  const auto rail = arc(R, 0.25, 401);
  const auto mid = horizontal_versines(rail, 0.25, {20.0, 10.0});
  const auto off = horizontal_versines(rail, 0.25, {10.0, 3.0});
  // P at the middle of the arc of length L: R (1 - cos(L / 2R)).
  EXPECT_NEAR(mid[200], R * (1.0 - std::cos(10.0 / R)), 1e-8);
  EXPECT_NEAR(off[200], 3.0 * 7.0 / (2.0 * R), 1e-6);
  EXPECT_TRUE(std::isnan(mid[39]));
  EXPECT_FALSE(std::isnan(mid[40]));
  EXPECT_TRUE(std::isnan(mid[361]));
}

TEST(Versine, MidChordGainOfASine) {
  for (const double wavelength : {5.0, 10.0, 17.0, 40.0}) {
    std::vector<double> e;
    for (int i = 0; i < 800; ++i) e.push_back(std::cos(two_pi * (0.25 * i - 100.0) / wavelength));
    EXPECT_NEAR(scalar_versines(e, 0.25, {20.0, 10.0})[400], 1.0 - std::cos(std::numbers::pi * 20.0 / wavelength),
                1e-9);
  }
}

TEST(ChordCheck, GainsOfTheP25Phase) {
  const ChordCheck c30{"30m", 30.0, 15.0, 5.0}, c300{"300m", 300.0, 15.0, 150.0};
  // notes: gains of the 30 m and 300 m checks; the points are on a 0.625 m grid
  EXPECT_NEAR(chord_check_gain(c30, 5), 0.0, 1e-9);
  EXPECT_NEAR(chord_check_gain(c30, 10), 2.0, 1e-9);
  EXPECT_NEAR(chord_check_gain(c30, 30), 1.0, 1e-9);
  EXPECT_NEAR(chord_check_gain(c30, 40), 0.56, 0.006);
  EXPECT_NEAR(chord_check_gain(c30, 60), 0.21, 0.005);
  for (const double w : {25.0, 30.0, 50.0, 150.0}) EXPECT_NEAR(chord_check_gain(c300, w), 0.0, 1e-9);
  EXPECT_NEAR(chord_check_gain(c300, 100), 2.0, 1e-9);
  EXPECT_NEAR(chord_check_gain(c300, 200), 1.46, 0.005);
  EXPECT_NEAR(chord_check_gain(c300, 600), 0.84, 0.005);
}

TEST(ChordCheck, EqualsItsDefinitionPointByPointAndWorstPhaseIsNeverSmaller) {
  std::vector<double> e;
  for (int i = 0; i < 1200; ++i) e.push_back(0.003 * std::sin(0.11 * i) + 0.002 * std::sin(0.031 * i + 1));
  const ChordCheck c{"30m", 30.0, 15.0, 5.0};
  const auto d = chord_check(e, 0.625, c), worst = chord_check_worst(e, 0.625, c);
  for (std::size_t i = 100; i < 1000; ++i) {
    // P1 = i - 24, P25 = i, P33 = i + 8, P49 = i + 24
    const double expected = (e[i] - e[i + 8]) + 8.0 / 48.0 * (e[i + 24] - e[i - 24]);
    EXPECT_NEAR(d[i], expected, 1e-12);
    double best = 0.0;
    for (std::size_t a = 0; a <= 40; ++a) {
      const double v = (e[i] - e[i + 8]) + 8.0 / 48.0 * (e[i - a + 48] - e[i - a]);
      if (std::abs(v) > std::abs(best)) best = v;
    }
    EXPECT_NEAR(worst[i], best, 1e-12);
  }
}

TEST(Grid, FractionalIndexIsCubic) {
  std::vector<double> x;
  for (int i = 0; i < 10; ++i) x.push_back(0.1 * i * i * i - i);
  EXPECT_NEAR(grid_value(x, 4.3), 0.1 * 4.3 * 4.3 * 4.3 - 4.3, 1e-12);
  EXPECT_TRUE(std::isnan(grid_value(x, -0.5)));
  EXPECT_TRUE(std::isnan(grid_value(x, 9.5)));
}

}  // namespace
}  // namespace versine::track
