// SPDX-License-Identifier: Apache-2.0
#include "versine/stationing/free_station.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "generator.hpp"

namespace versine::stationing {
namespace {

using namespace test;
using ::testing::HasSubstr;

struct Case {
  ControlNetwork network;
  Truth truth;
  Stationing readings;
};

Case make_case(unsigned seed, std::size_t count = 7, double at = 200.0, int sets = 1, bool faces = true) {
  std::mt19937 rng(seed);
  auto nominal = pairs_along(420.0, rng);
  const auto real = real_places(nominal, rng);
  Case c{.network = *ControlNetwork::create(nominal), .truth = trolley(at, rng)};
  c.readings = readings(c.truth, real, count, sets, rng, faces);
  return c;
}

Expected<StationResult> solve(const Case& c, const FreeStationOptions& options = {}) {
  auto reduced = reduce(c.readings, Instrument{});
  if (!reduced) return tl::unexpected(reduced.error());
  return free_station(*reduced, c.network, Instrument{}, options);
}

Eigen::Matrix<double, 6, 1> corrections(const StationResult& r, const Truth& t) {
  Eigen::Matrix<double, 6, 1> e;
  e << t.position - r.position, geodesy::to_rotation_vector(t.q_ms * r.q_ms.conjugate());
  return e;
}

// Half a millimetre of control and an instrument of 0.5", 0.6 mm + 1 ppm: the position's error, and whether its
// covariance (with the correlations between position and attitude) is honest.
TEST(FreeStation, MonteCarloAccuracyAndHonesty) {
  const int runs = 1000;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  double nees = 0.0;
  int covered = 0, covered_attitude = 0, lost = 0;
  for (int k = 0; k < runs; ++k) {
    const Case c = make_case(1000 + k, 5 + k % 4, 190.0 + k % 60);
    const auto r = solve(c);
    ASSERT_TRUE(r) << r.error().message();
    const auto e = corrections(*r, c.truth);
    const Eigen::Matrix<double, 6, 6> p = r->covariance.topLeftCorner<6, 6>();
    squares += e.head<3>().cwiseAbs2();
    nees += e.dot(p.llt().solve(e));
    for (int i = 0; i < 3; ++i) {
      covered += std::abs(e(i)) < 1.96 * std::sqrt(p(i, i));
      covered_attitude += std::abs(e(i + 3)) < 1.96 * std::sqrt(p(i + 3, i + 3));
    }
    lost += static_cast<int>(r->excluded.size());
  }
  const Eigen::Vector3d rms = (squares / runs).cwiseSqrt();
  const double coverage = covered / (3.0 * runs), coverage_attitude = covered_attitude / (3.0 * runs);
  RecordProperty("rms_mm", std::to_string(rms.maxCoeff() * 1e3));
  RecordProperty("coverage", std::to_string(coverage));
  std::printf("rms north east down %.3f %.3f %.3f mm, coverage %.3f, attitude %.3f, NEES %.3f, lost %d\n",
              rms.x() * 1e3, rms.y() * 1e3, rms.z() * 1e3, coverage, coverage_attitude, nees / runs, lost);
  EXPECT_LT(rms.maxCoeff(), 0.5e-3);
  EXPECT_NEAR(coverage, 0.95, 0.02);
  EXPECT_NEAR(coverage_attitude, 0.95, 0.02);
  EXPECT_NEAR(nees / runs, 6.0, 0.35);
  EXPECT_LT(lost, 0.003 * 6.5 * runs);
}

TEST(FreeStation, FindsAndNamesBlundersOfFiveMillimetresAndMore) {
  int found = 0, wrong = 0;
  const int runs = 300;
  for (int k = 0; k < runs; ++k) {
    Case c = make_case(5000 + k, 8, 190.0 + k % 60);
    std::mt19937 rng(k);
    std::uniform_real_distribution<double> size(5e-3, 0.2);
    const std::string victim = c.readings.sightings[2 * (k % 8)].point;
    const double blunder = (k % 2 ? 1.0 : -1.0) * size(rng);
    for (auto& s : c.readings.sightings) {
      if (s.point != victim) continue;
      if (k % 3 == 0) s.distance += blunder;
      if (k % 3 == 1) s.direction += blunder / s.distance;
      if (k % 3 == 2) s.zenith += (s.face == Face::one ? 1.0 : -1.0) * blunder / s.distance;
    }
    const auto r = solve(c);
    ASSERT_TRUE(r) << r.error().message();
    bool hit = false;
    for (const auto& e : r->excluded) (e.point == victim ? hit = true : ++wrong);
    found += hit;
  }
  std::printf("blunders found %d of %d, good targets lost %d\n", found, runs, wrong);
  EXPECT_EQ(found, runs);
  EXPECT_LT(wrong, 0.005 * 8 * runs);
}

TEST(FreeStation, SwappedNumbersAreNamedAndMended) {
  Case c = make_case(1, 7);
  const std::string a = c.readings.sightings[0].point, b = c.readings.sightings[6].point;
  for (auto& s : c.readings.sightings) s.point = s.point == a ? b : s.point == b ? a : s.point;
  const auto r = solve(c);
  ASSERT_TRUE(r) << r.error().message();
  EXPECT_LT((r->position - c.truth.position).norm(), 2e-3);
  ASSERT_EQ(r->excluded.size(), 2u);
  for (const auto& e : r->excluded) {
    EXPECT_EQ(e.reason, Exclusion::Reason::wrong_name);
    EXPECT_EQ(e.is, e.point == a ? b : a);
  }
  EXPECT_EQ(r->targets.size(), 7u);
}

TEST(FreeStation, FindsPointsWithoutNumbersByTheirCoordinates) {
  Case c = make_case(2, 6);
  for (auto& s : c.readings.sightings) s.point.clear();
  const auto r = solve(c);
  ASSERT_TRUE(r) << r.error().message();
  EXPECT_LT((r->position - c.truth.position).norm(), 2e-3);
  EXPECT_EQ(r->targets.size(), 6u);

  Case unknown = make_case(3, 6);
  for (auto& s : unknown.readings.sightings) {
    if (s.point == unknown.readings.sightings[0].point && &s != &unknown.readings.sightings[0]) s.point = "X9";
  }
  unknown.readings.sightings[0].point = "X9";
  const auto u = solve(unknown);
  ASSERT_TRUE(u) << u.error().message();
  EXPECT_EQ(u->targets.size(), 6u);
  EXPECT_THAT(u->warnings, ::testing::Contains(HasSubstr("'X9' is CP")));
}

// A prism that is in no list: told so, by number or without one, and the station stands as if it had not been read.
TEST(FreeStation, UnknownPointIsNamedAndLeftOut) {
  for (const char* number : {"X77", ""}) {
    Case c = make_case(31, 6);
    const auto without = solve(c);
    std::mt19937 rng(31);
    const ControlPoint stray{.name = "stray", .position = c.truth.position + Eigen::Vector3d(31.0, 12.0, -2.0)};
    sight(c.readings, c.truth, stray, number, 1, true, {}, rng);
    const auto r = solve(c);
    ASSERT_TRUE(r && without) << r.error().message();
    ASSERT_EQ(r->excluded.size(), 1u);
    EXPECT_EQ(r->excluded[0].reason, Exclusion::Reason::unknown_point);
    EXPECT_EQ(r->excluded[0].point, number);
    EXPECT_EQ(r->targets.size(), 6u);
    // The stray prism has told collimation and index error a little, nothing else.
    EXPECT_LT((r->position - without->position).norm(), 0.05e-3);
  }
}

TEST(FreeStation, MovedControlPointIsNamedAcrossStations) {
  std::mt19937 rng(7);
  auto nominal = pairs_along(600.0, rng);
  auto real = real_places(nominal, rng);
  real[8].position += Eigen::Vector3d(6e-3, -4e-3, 2e-3);
  std::vector<Stationing> all;
  for (double s = 60.0; s < 540.0; s += 60.0) {
    all.push_back(readings(trolley(s + 20.0, rng), real, 8, 1, rng));
    all.back().name = "S" + std::to_string(int(s));
  }
  SilentProgress progress;
  const auto run = compute_stations(all, *ControlNetwork::create(nominal), {}, {}, progress);
  EXPECT_TRUE(run.failed.empty());
  ASSERT_EQ(run.moved.size(), 1u);
  EXPECT_EQ(run.moved[0].name, nominal[8].name);
  EXPECT_LT((run.moved[0].offset - Eigen::Vector3d(6e-3, -4e-3, 2e-3)).norm(), 2e-3);
  for (const auto& s : run.stations) {
    for (const auto& t : s.targets) EXPECT_NE(t.point, nominal[8].name);
  }
}

TEST(FreeStation, ScaleIsSolvedForWhenAsked) {
  Case c = make_case(11, 8, 200.0, 3);
  for (auto& s : c.readings.sightings) s.distance *= 1.0 + 100e-6;
  const auto r = solve(c, {.solve_scale = true});
  ASSERT_TRUE(r) << r.error().message();
  EXPECT_NEAR(r->scale, 1.0 - 100e-6, 4.0 * std::sqrt(r->covariance(6, 6)));
  EXPECT_LT(std::sqrt(r->covariance(6, 6)), 10e-6);
}

// The detectable blunder is what its name says: put into a distance, it is found in four of five cases by the test of
// that distance.
TEST(FreeStation, MinimumDetectableBlunderHasItsPower) {
  int found = 0;
  const int runs = 400;
  for (int k = 0; k < runs; ++k) {
    Case c = make_case(20000 + k, 7);
    const auto clean = solve(c);
    ASSERT_TRUE(clean);
    const std::string victim = clean->targets[2].point;
    for (auto& s : c.readings.sightings) {
      if (s.point == victim) s.distance += clean->targets[2].detectable.z();
    }
    const auto r = solve(c, {.significance = 1e-12});  // nothing is left out, so that the test itself is seen
    ASSERT_TRUE(r);
    for (const auto& t : r->targets) {
      if (t.point == victim) found += std::abs(t.normalized.z()) > 3.2905;
    }
  }
  EXPECT_NEAR(found / double(runs), 0.80, 0.06);
}

TEST(FreeStation, JudgesTheGeometry) {
  EXPECT_EQ(solve(make_case(4, 8))->geometry.grade, GeometryVerdict::Grade::good);
  Case c = make_case(4, 10, 30.0);  // all ahead: only points beyond 80 m
  std::erase_if(c.readings.sightings, [](const Sighting& s) { return s.distance < 80.0; });
  const auto r = solve(c);
  ASSERT_TRUE(r) << r.error().message();
  EXPECT_EQ(r->geometry.grade, GeometryVerdict::Grade::poor);
  EXPECT_THAT(r->geometry.remarks, ::testing::Contains(HasSubstr("all back-sights within")));
}

TEST(FreeStation, RefusesWithTheCure) {
  Case few = make_case(5, 2);
  EXPECT_THAT(solve(few).error().message(), HasSubstr("at least 3 targets"));

  Case gon = make_case(6, 6, 200.0, 1, false);  // read as gon, though the instrument showed degrees
  for (auto& s : gon.readings.sightings) {
    s.direction = 0.9 * (s.direction < 0.0 ? s.direction + 2.0 * M_PI : s.direction);
    s.zenith *= 0.9;
  }
  EXPECT_THAT(solve(gon).error().message(), HasSubstr("degrees"));
  Case faces = make_case(6, 6);
  for (auto& s : faces.readings.sightings) s.direction *= 0.9, s.zenith *= 0.9;
  EXPECT_THAT(solve(faces).error().message(), HasSubstr("name it zenith_deg"));

  Case prism = make_case(7, 8);
  for (auto& s : prism.readings.sightings) s.distance += 17.5e-3;
  const auto p = solve(prism);
  ASSERT_FALSE(p);
  EXPECT_THAT(p.error().message(), HasSubstr("prism constant"));
  EXPECT_THAT(p.error().message(), HasSubstr("too long"));

  Case exchanged = make_case(8, 7);
  auto points = exchanged.network.points();
  for (auto& x : points) x.position = {x.position.y(), x.position.x(), x.position.z()};
  exchanged.network = *ControlNetwork::create(points);
  // The track of the generator runs north-east and is its own mirror image; the numbers tell the difference.
  EXPECT_THAT(solve(exchanged, {.identify = false}).error().message(), HasSubstr("exchanged"));

  std::vector<ControlPoint> line;
  for (int i = 0; i < 5; ++i)
    line.push_back({.name = "L" + std::to_string(i), .position = {20.0 * i - 40.0, 3.0, -1.0}});
  std::mt19937 rng(9);
  Case on_line{.network = *ControlNetwork::create(line), .truth = {{0, 0, -0.5}, Eigen::Quaterniond::Identity()}};
  on_line.readings = readings(on_line.truth, line, 5, 1, rng);
  EXPECT_THAT(solve(on_line).error().message(), HasSubstr("on a line"));
}

TEST(FreeStation, LevelledStationNeedsTwoPoints) {
  std::mt19937 rng(10);
  const auto points = pairs_along(240.0, rng);
  const Truth truth{{60.0, 60.0, -0.5}, geodesy::to_quaternion({.yaw = 1.0})};
  Case c{.network = *ControlNetwork::create(points), .truth = truth};
  c.readings = readings(truth, points, 2, 1, rng);
  const auto r = solve(c, {.tilt_sigma = 1.0 * units::arcsec});
  ASSERT_TRUE(r) << r.error().message();
  EXPECT_LT((r->position - truth.position).norm(), 3e-3);
}

TEST(FreeStation, LocatesThePrismOfATrolley) {
  int inside = 0;
  const int runs = 300;
  for (int k = 0; k < runs; ++k) {
    Case c = make_case(30000 + k, 7);
    const auto r = solve(c);
    ASSERT_TRUE(r);
    std::mt19937 rng(k);
    const ControlPoint prism{.name = "P", .position = c.truth.position + Eigen::Vector3d(40.0, 38.0, -0.2)};
    Stationing s{.name = "P"};
    sight(s, c.truth, prism, "P", 1, true, {}, rng);
    const auto located = locate(*r, reduce(s, Instrument{})->targets[0], Instrument{});
    const Eigen::Vector3d e = located.position - prism.position;
    inside += e.dot(located.covariance.llt().solve(e)) < 7.815;
  }
  EXPECT_NEAR(inside / double(runs), 0.95, 0.035);
}

TEST(FreeStation, ThousandStationingsInLessThanTwoSeconds) {
  std::mt19937 rng(12);
  const auto points = pairs_along(60000.0, rng);
  const auto network = *ControlNetwork::create(points);
  std::vector<Stationing> all;
  for (int k = 0; k < 1000; ++k) {
    const Truth truth = trolley(60.0 * k + 30.0, rng);
    std::vector<ControlPoint> near;
    for (const auto i : network.within(truth.position, 160.0)) near.push_back(points[i]);
    all.push_back(readings(truth, near, std::min<std::size_t>(8, near.size()), 1, rng));
    all.back().name = std::to_string(k);
    if (k % 10 == 0) all.back().sightings[3].distance += 0.05;
  }
  SilentProgress progress;
  const auto begin = std::clock();
  const auto run = compute_stations(all, network, {}, {}, progress);
  const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
  std::printf("1000 stationings: %.3f s of processor time, %zu failed\n", seconds, run.failed.size());
  EXPECT_EQ(run.failed.size(), 0u);
  EXPECT_LT(seconds, 2.0);
}

}  // namespace
}  // namespace versine::stationing
