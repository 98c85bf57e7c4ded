// SPDX-License-Identifier: Apache-2.0
#include "versine/design/axis_index.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <numbers>
#include <random>

#include "versine/core/numbers.hpp"

namespace versine::design {
namespace {

/// Curves of all kinds, right and left, repeated until the line is long enough.
HorizontalAxis long_line(double length) {
  std::vector<HorizontalElement> elements;
  double total = 0.0;
  for (int i = 0; total < length; ++i) {
    const auto shape = static_cast<Shape>(2 + i % 7);
    const double radius = (i % 2 == 0 ? 1.0 : -1.0) * (400.0 + 37.0 * (i % 29));
    elements.push_back(line(150.0 + 13.0 * (i % 17)));
    elements.push_back(transition(shape, 90.0, inf, radius));
    if (shape == Shape::viennese) elements.back().cant_term = std::copysign(0.18, radius);
    elements.push_back(arc(180.0, radius));
    elements.push_back(transition(shape, 110.0, elements[elements.size() - 1].curvature_end == 0 ? inf : radius, inf));
    for (std::size_t k = elements.size() - 4; k < elements.size(); ++k) total += elements[k].length;
  }
  return *HorizontalAxis::chain({500000.0, 5600000.0, 0.3}, elements);
}

TEST(AxisIndex, FindsTheFootOfPointsBesideEveryElement) {
  const AxisIndex index(long_line(12e3));
  for (double s = 0.05; s < index.axis().length(); s += 3.7) {
    for (const double offset : {-60.0, -1.5, -1e-4, 0.0, 0.75, 80.0}) {
      const MapPose p = index.place(s, offset);
      const AxisFoot foot = index.project(p.easting, p.northing, {s - 200.0, s + 200.0});
      ASSERT_NEAR(foot.distance, s, 2e-8) << offset;
      ASSERT_NEAR(foot.offset, offset, 2e-8);
      ASSERT_TRUE(foot.inside);
    }
  }
}

TEST(AxisIndex, NoPlaceIsNearerThanTheFoot) {
  const AxisIndex index(long_line(6e3));
  std::vector<AxisPose> dense;
  for (double s = 0.0; s <= index.axis().length(); s += 0.5) dense.push_back(index.axis().at(s));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(-1500.0, 1500.0);
  for (int i = 0; i < 500; ++i) {
    const AxisPose& near = dense[random() % dense.size()];
    const double e = near.easting + at(random), n = near.northing + at(random);
    double brute = inf;
    for (const AxisPose& p : dense) brute = std::min(brute, std::hypot(p.easting - e, p.northing - n));
    const AxisFoot foot = index.project(e, n);
    const AxisPose p = index.axis().at(std::clamp(foot.distance, 0.0, index.axis().length()));
    const double found = std::hypot(p.easting - e, p.northing - n);
    EXPECT_LE(found, brute + 1e-9);
    EXPECT_GE(found, brute - 0.25);
  }
}

TEST(AxisIndex, FullCircleAndItsCentre) {
  const double r = 300.0;
  const AxisIndex index(*HorizontalAxis::chain({0.0, 0.0, 0.0}, {arc(2.0 * std::numbers::pi * r - 1.0, r)}));
  for (double a = 0.1; a < 6.2; a += 0.1) {
    for (const double radius : {0.01, 150.0, 299.0, 300.0, 301.0, 5000.0}) {
      const AxisFoot foot = index.project(r - radius * std::cos(a), radius * std::sin(a));
      EXPECT_NEAR(foot.offset, r - radius, 1e-8);
      EXPECT_NEAR(foot.distance, r * a, 1e-6) << radius;
    }
  }
  EXPECT_NEAR(std::abs(index.project(r, 0.0).offset), r, 1e-9);  // the centre: any place will do
}

TEST(AxisIndex, EndsAreExtendedAlongTheTangentAndFlagged) {
  const AxisIndex index(*HorizontalAxis::chain({0.0, 0.0, 0.0}, {line(100.0), arc(100.0, 500.0)}));
  const AxisFoot before = index.project(3.0, -20.0);
  EXPECT_FALSE(before.inside);
  EXPECT_NEAR(before.distance, -20.0, 1e-12);
  EXPECT_NEAR(before.offset, 3.0, 1e-12);
  const MapPose beyond = index.place(230.0, -2.0);
  const AxisFoot after = index.project(beyond.easting, beyond.northing);
  EXPECT_FALSE(after.inside);
  EXPECT_NEAR(after.distance, 230.0, 1e-9);
  EXPECT_NEAR(after.offset, -2.0, 1e-9);
}

TEST(AxisIndex, ARunStaysOnItsOwnTurnOfALineThatCrossesItself) {
  // A loop that turns by 400 degrees and crosses itself.
  const AxisIndex index(
      *HorizontalAxis::chain({0.0, 0.0, 0.0}, {line(500.0), arc(400.0 / 180.0 * 3.14159 * 200.0, 200.0), line(700.0)}));
  std::vector<MapPosition> run;
  std::vector<double> truth;
  for (double s = 0.0; s < index.axis().length(); s += 1.0) {
    const MapPose p = index.place(s, 0.3 * std::sin(s));
    run.push_back({p.easting, p.northing});
    truth.push_back(s);
  }
  const std::vector<AxisFoot> feet = project_run(index, run);
  for (std::size_t i = 0; i < run.size(); ++i) ASSERT_NEAR(feet[i].distance, truth[i], 1e-7);
}

TEST(AxisIndex, HundredThousandPointsPerSecondOnAHundredKilometres) {
  const AxisIndex index(long_line(100e3));
  std::vector<MapPosition> run;
  for (double s = 0.0; s < index.axis().length(); s += 1.0) {
    const MapPose p = index.place(s, 0.7);
    run.push_back({p.easting, p.northing});
  }
  const auto cpu = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  double t = cpu(), sum = 0.0;
  for (const MapPosition& p : run) sum += index.project(p.easting, p.northing).offset;
  const double whole = static_cast<double>(run.size()) / (cpu() - t);
  t = cpu();
  for (const AxisFoot& f : project_run(index, run)) sum += f.offset;
  const double following = static_cast<double>(run.size()) / (cpu() - t);
  std::printf("projection on %.0f km: %.0f points/s searching the whole axis, %.0f following a run (mean %.3f m)\n",
              index.axis().length() / 1e3, whole, following, sum / 2.0 / static_cast<double>(run.size()));
#ifdef NDEBUG
  EXPECT_GT(whole, 1e5);
  EXPECT_GT(following, 1e5);
#endif
}

}  // namespace
}  // namespace versine::design
