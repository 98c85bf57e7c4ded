// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <random>

#include "simulated.hpp"

/// Journeys with known truth on a made network: two parallel lines with crossovers, IMU at 100 Hz, GNSS at 5 Hz with
/// errors correlated in time.
namespace versine::georef {
namespace {

TEST(SimulatedJourney, DistanceWithinItsSigmaAndMonotone) {
  const auto map = chain(5);
  std::mt19937 random(1);
  double square = 0.0, nees = 0.0;
  std::size_t n = 0, inside = 0, right = 0;
  const int runs = 12;
  for (int run = 0; run < runs; ++run) {
    const auto s = simulate(*map, random, 240.0, 1.0);
    const auto result = georeference(*map, s.recording, honest());
    ASSERT_TRUE(result) << result.error().message();
    ASSERT_EQ(result->journeys.size(), 1u);
    const auto& j = result->journeys[0];
    const auto& best = j.paths[0];
    EXPECT_TRUE(std::is_sorted(best.motion.distance.begin(), best.motion.distance.end()));
    const network::PathCoordinates truth(map->network, s.path);
    right += std::search(s.path.begin(), s.path.end(), best.coordinates.path().begin(),
                         best.coordinates.path().end()) != s.path.end();
    for (std::size_t i = 0; i < j.steps; i += 100) {
      const auto k = static_cast<std::size_t>((j.start.ns / 10'000'000)) + i;
      // Along the line both are the same metres, whichever track was taken.
      const double e = best.coordinates.position(best.motion.distance[i]).x() - truth.position(s.distance[k]).x();
      const double sigma = best.motion.sigma_distance[i];
      square += e * e, nees += e * e / (sigma * sigma), inside += std::abs(e) < 1.96 * sigma, ++n;
    }
  }
  const double rms = std::sqrt(square / static_cast<double>(n)),
               coverage = static_cast<double>(inside) / static_cast<double>(n);
  RecordProperty("rms_mm", static_cast<int>(1000 * rms));
  RecordProperty("coverage_permille", static_cast<int>(1000 * coverage));
  fmt::print("rms {:.3f} m, coverage {:.3f}, NEES {:.2f}, right paths {}/{}\n", rms, coverage,
             nees / static_cast<double>(n), right, runs);
  EXPECT_LT(rms, 0.5);
  EXPECT_GT(coverage, 0.85);
}

TEST(SimulatedJourney, FourteenScissorsCostNoMoreThanLinearly) {
  const auto seconds = [](int crossings) {
    const auto map = chain(crossings);
    std::vector<Knot> knots;
    for (int i = 0; i < crossings * 20; ++i) {
      const double x = 20.0 * i;
      knots.push_back(
          {{static_cast<std::int64_t>(i) * 2'000'000'000},
           Eigen::Vector2d(500000.0 + x, 5500000.0 + 60.0 * std::sin(x / 500.0) + 2.25) - map->network.origin,
           2.0,
           1.0,
           -1.0});
    }
    const auto begin = std::clock();
    const auto stretches = infer_paths(*map, knots, {});
    EXPECT_EQ(stretches.size(), 1u);
    EXPECT_EQ(stretches[0].hypotheses.size(), 16u);
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  };
  const double half = seconds(7), whole = seconds(14);
  fmt::print("7 crossovers {:.4f} s, 14 {:.4f} s\n", half, whole);
  EXPECT_LT(whole, 4.0 * half + 0.01);
}

TEST(SimulatedJourney, TenMinutesInTime) {
  const auto map = chain(15);
  std::mt19937 random(3);
  const auto s = simulate(*map, random, 600.0, 1.5);
  const auto begin = std::clock();
  const auto result = georeference(*map, s.recording, honest());
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  ASSERT_TRUE(result);
  fmt::print("10 minutes: {:.3f} s CPU, {} paths\n", seconds, result->journeys[0].paths.size());
  EXPECT_LT(seconds, 0.5);
}

TEST(BadRecording, StandingClockBackwardTimeAndSwappedCoordinatesAreNamed) {
  const auto map = chain(2);
  std::mt19937 random(5);
  auto s = simulate(*map, random, 120.0, 1.0);
  auto r = s.recording;
  for (std::size_t i = 100; i < 110; ++i) r.gnss[i].time = r.gnss[99].time;
  r.gnss[300].time = r.gnss[200].time;
  auto result = georeference(*map, r, honest());
  ASSERT_TRUE(result);
  std::vector<std::string> kinds;
  for (const auto& f : result->record.findings) kinds.push_back(f.kind);
  EXPECT_NE(std::find(kinds.begin(), kinds.end(), "standing clock"), kinds.end());
  EXPECT_NE(std::find(kinds.begin(), kinds.end(), "time running backwards"), kinds.end());

  r = s.recording;
  r.name = "swapped.csv";
  for (auto& f : r.gnss.samples) std::swap(f.position.latitude, f.position.longitude);
  result = georeference(*map, r, honest());
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().file, "swapped.csv");
  EXPECT_NE(result.error().found.find("exchanged"), std::string::npos) << result.error().message();
}

TEST(Constraint, AReviewersTrackIsHonoured) {
  const auto map = chain(2);
  std::mt19937 random(7);
  const auto s = simulate(*map, random, 120.0, 3.0);
  const Constraint c{{}, {0}, {120'000'000'000}, {"b1"}, true, {}};
  const auto result = georeference(*map, s.recording, honest(), std::span(&c, 1));
  ASSERT_TRUE(result);
  for (const auto& p : result->journeys[0].paths) {
    for (const auto& t : p.coordinates.path()) EXPECT_NE(map->network.tracks[t.track].id, "b1");
  }
}

}  // namespace
}  // namespace versine::georef
