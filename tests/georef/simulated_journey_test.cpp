// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <random>

#include "versine/georef/georeference.hpp"
#include "versine/network/build.hpp"

/// Journeys with known truth on a made network: two parallel lines with crossovers, IMU at 100 Hz, GNSS at 5 Hz with
/// errors correlated in time.
namespace versine::georef {
namespace {

/// `crossings` scissors crossovers, 4.5 m between the lines, 400 m from one to the next.
network::NetworkSource scissors_chain(int crossings) {
  network::NetworkSource s;
  s.file = "made";
  s.crs = "EPSG:32632";
  const auto line = [&](std::string id, std::vector<Eigen::Vector2d> points) {
    for (auto& p : points) p += Eigen::Vector2d(500000.0, 5500000.0);
    s.tracks.push_back({std::move(id), points, s.tracks.size() + 1, {}, {}, {}});
  };
  const auto bend = [](double x) { return 60.0 * std::sin(x / 500.0); };
  const auto piece = [&](double from, double to, double y0, double y1) {
    std::vector<Eigen::Vector2d> points;
    const int n = std::max(2, static_cast<int>((to - from) / 10.0) + 1);
    for (int i = 0; i < n; ++i) {
      const double u = static_cast<double>(i) / (n - 1), x = from + u * (to - from);
      points.emplace_back(x, bend(x) + y0 + (y1 - y0) * u);
    }
    return points;
  };
  double x = 0.0;
  for (int k = 0; k <= crossings; ++k, x += 400.0) {
    for (const double y : {0.0, 4.5}) line(fmt::format("{}{}", y > 0 ? "b" : "a", k), piece(x, x + 340.0, y, y));
    if (k == crossings) break;
    for (const double y : {0.0, 4.5}) {
      line(fmt::format("{}x{}", y > 0 ? "b" : "a", k), piece(x + 340.0, x + 400.0, y, y));
      line(fmt::format("c{}{}", y > 0 ? "b" : "a", k), piece(x + 340.0, x + 400.0, y, 4.5 - y));
    }
  }
  return s;
}

struct Simulated {
  Recording recording;
  network::Path path;
  std::vector<double> distance;  // every 0.01 s
};

Simulated simulate(const Map& map, std::mt19937& random, double seconds, double sigma) {
  std::normal_distribution<double> normal;
  Simulated s;
  s.path.push_back({static_cast<network::TrackIndex>(std::uniform_int_distribution<int>(0, 1)(random)), false});
  for (auto out = map.graph.successors(s.path.back()); !out.empty(); out = map.graph.successors(s.path.back())) {
    s.path.push_back(out[std::uniform_int_distribution<std::size_t>(0, out.size() - 1)(random)].to);
  }
  const network::PathCoordinates path(map.network, s.path);
  const double T = 0.01, bias = 0.05 * normal(random), tau = 15.0;
  double d = 30.0, v = 0.0, slope = 0.0;
  Eigen::Vector2d colour(normal(random), normal(random));
  const int n = static_cast<int>(seconds / T), stand = 1500;
  for (int k = 0; k < n; ++k) {
    const bool stands = k < stand || k > n - stand;
    const double left = path.length() - 60.0 - d, brake = 0.5;
    double a = 0.0;
    if (!stands)
      a = v * v / (2.0 * brake) > left - 2.0 ? -brake * (v > 0.05 ? 1.0 : v / 0.05)
                                             : (v < 13.0 ? 0.4 : 0.1 * std::sin(0.002 * k));
    if (v + T * a < 0.0) a = -v / T;
    slope += T * (-slope / 40.0) + 0.03 * std::sqrt(2.0 * T / 40.0) * normal(random);
    if (v < 0.01) slope = 0.0;
    const Time t{static_cast<std::int64_t>(k) * 10'000'000};
    s.recording.imu.samples.push_back(
        {t, {a + bias + slope + 0.3 * normal(random), 0.3 * normal(random), -9.81 + 0.3 * normal(random)}, {}});
    s.distance.push_back(d);
    if (k % 20 == 0) {
      const double f = std::exp(-0.2 / tau);
      for (int i = 0; i < 2; ++i) colour[i] = f * colour[i] + std::sqrt(1.0 - f * f) * normal(random);
      Eigen::Vector2d e =
          sigma * (std::sqrt(0.8) * colour + std::sqrt(0.2) * Eigen::Vector2d(normal(random), normal(random)));
      Fix fix{t, map.network.to_geodetic(path.position(d) + e), sigma, std::abs(v + 0.1 * normal(random)), 0.1};
      s.recording.gnss.samples.push_back(fix);
    }
    d += T * v + 0.5 * T * T * a;
    v += T * a;
  }
  return s;
}

std::unique_ptr<Map> chain(int crossings) {
  return std::make_unique<Map>(std::move(*network::build(scissors_chain(crossings))));
}

Options honest() {
  Options o;
  o.gnss.scale = 1.0;
  o.gnss.map_sigma = 0.1;
  o.gnss.speed_scale = 1.0;
  o.inference.diverging = 0.5;
  return o;
}

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
