// SPDX-License-Identifier: Apache-2.0
#include "versine/stationing/reduction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "generator.hpp"
#include "versine/stationing/air.hpp"

namespace versine::stationing {
namespace {

using namespace test;
using ::testing::HasSubstr;

const Noise exact{.angle = 0.0,
                  .distance = 0.0,
                  .ppm = 0.0,
                  .target = 0.0,
                  .collimation = 20 * units::arcsec,
                  .index = -15 * units::arcsec,
                  .refraction = 0.13};
const Truth truth{{0.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()};
const std::vector<ControlPoint> points{{.name = "A", .position = {50.0, 10.0, -3.0}},
                                       {.name = "B", .position = {-40.0, 25.0, 2.0}},
                                       {.name = "C", .position = {10.0, -60.0, -8.0}}};

void expect_exact(const Target& t, const Eigen::Vector3d& at) {
  EXPECT_NEAR(t.distance, at.norm(), 1e-9);
  EXPECT_NEAR(std::remainder(t.direction - std::atan2(at.y(), at.x()), 2 * M_PI), 0.0, 1e-9);
  EXPECT_NEAR(t.zenith, std::atan2(std::hypot(at.x(), at.y()), -at.z()), 1e-8);  // the two faces' refraction differs
}

TEST(Reduction, TwoFacesCancelCollimationAndIndexAndTellThem) {
  std::mt19937 rng(1);
  const auto r = reduce(readings(truth, points, 3, 2, rng, true, exact), Instrument{});
  ASSERT_TRUE(r) << r.error().message();
  EXPECT_NEAR(*r->collimation, 20 * units::arcsec, 1e-9);
  EXPECT_NEAR(*r->index_error, -15 * units::arcsec, 1e-9);
  for (const auto& t : r->targets) {
    expect_exact(t, points[static_cast<std::size_t>(t.point[0] - 'A')].position);
    EXPECT_EQ(t.readings, 4u);
    EXPECT_NEAR(t.direction_sigma, 0.5 * units::arcsec / std::sqrt(2.0), 1e-12);
  }
}

TEST(Reduction, OneFaceIsWarnedOfAndTakesTheCalibration) {
  std::mt19937 rng(1);
  const auto s = readings(truth, points, 3, 1, rng, false, exact);
  const auto bare = reduce(s, Instrument{});
  ASSERT_TRUE(bare);
  EXPECT_THAT(bare->warnings, ::testing::ElementsAre(HasSubstr("measure face II")));
  const auto known = reduce(s, {.collimation = 20 * units::arcsec, .index_error = -15 * units::arcsec});
  ASSERT_TRUE(known);
  EXPECT_TRUE(known->warnings.empty());
  for (const auto& t : known->targets) expect_exact(t, points[static_cast<std::size_t>(t.point[0] - 'A')].position);
}

TEST(Reduction, SetsWithATurnedCircleComeTogether) {
  std::mt19937 rng(2);
  auto s = readings(truth, points, 3, 3, rng, true, exact);
  for (auto& r : s.sightings) r.direction = std::fmod(r.direction + 1.1 * (r.set - 1) + 2.0 * M_PI, 2.0 * M_PI);
  const auto r = reduce(s, Instrument{});
  ASSERT_TRUE(r);
  EXPECT_EQ(r->sets, 3u);
  for (const auto& t : r->targets) {
    expect_exact(t, points[static_cast<std::size_t>(t.point[0] - 'A')].position);
    EXPECT_LT(t.direction_spread, 1e-9);
  }
}

TEST(Reduction, AReadingThatContradictsTheOtherSetsIsLeftOut) {
  std::mt19937 rng(3);
  auto s = readings(truth, points, 3, 4, rng, true, exact);
  s.sightings[2].direction += 20 * units::arcsec;
  s.sightings[2].distance += 0.02;
  const auto r = reduce(s, Instrument{});
  ASSERT_TRUE(r);
  EXPECT_EQ(r->dropped, 2u);
  EXPECT_THAT(r->warnings, ::testing::Contains(HasSubstr("contradict the other sets")));
  for (const auto& t : r->targets) expect_exact(t, points[static_cast<std::size_t>(t.point[0] - 'A')].position);
}

TEST(Reduction, RefusesWhatIsNoReading) {
  std::mt19937 rng(4);
  auto s = readings(truth, points, 3, 1, rng);
  s.sightings[1].zenith = NAN;
  EXPECT_FALSE(reduce(s, Instrument{}));
  s = readings(truth, points, 3, 1, rng);
  s.sightings[0].target_height = 1.3;
  EXPECT_THAT(reduce(s, Instrument{}).error().message(), HasSubstr("target height"));
  EXPECT_THAT(reduce({.name = "S"}, Instrument{}).error().message(), HasSubstr("no readings"));
}

// Leica's formula for 658 nm (user manuals of the TPS series), referred to 12 deg C, 1013.25 hPa, 60 %.
TEST(Air, AgreesWithAnInstrumentMakersFormula) {
  const auto leica = [](double t, double p, double h) {
    const double x = 7.5 * t / (237.3 + t) + 0.7857, a = 1.0 + t / 273.15;
    return 286.338 - (0.29535 * p / a - 4.126e-4 * 100.0 * h / a * std::pow(10.0, x));
  };
  for (const double t : {-10.0, 12.0, 25.0, 35.0}) {
    for (const double p : {900.0, 1013.25}) {
      const double ppm = (distance_factor({t, p, 0.6}, {}, 0.658) - 1.0) * 1e6;
      EXPECT_NEAR(ppm, leica(t, p, 0.6) - leica(12.0, 1013.25, 0.6), 0.4) << t << " " << p;
    }
  }
}

TEST(ControlNetwork, FindsWhatTypingErrorsLeaveBehind) {
  std::mt19937 rng(6);
  auto list = pairs_along(600.0, rng);
  EXPECT_TRUE(check(*ControlNetwork::create(list)).empty());
  list[5].position.z() -= 30.0;
  list[9].position.x() += 3000.0;
  list.push_back({.name = "twin", .position = list[3].position});
  const auto findings = check(*ControlNetwork::create(list));
  EXPECT_EQ(findings.size(), 3u);
  list.push_back({.name = "twin", .position = list[4].position});
  EXPECT_THAT(ControlNetwork::create(list).error().message(), HasSubstr("two entries"));
}

}  // namespace
}  // namespace versine::stationing
