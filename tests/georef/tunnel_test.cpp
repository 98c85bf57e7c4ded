// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numbers>

#include "simulated.hpp"

/// Where no fix is: an odometer finds the way.
namespace versine::georef {
namespace {

/// A line into a hill and out of it, 206 m apart as the crow flies: by a straight tunnel, or by a spiral of 2.6 km.
std::unique_ptr<Map> hill() {
  network::NetworkSource s;
  s.file = "made";
  s.crs = "EPSG:32632";
  const auto line = [&](std::string id, auto point, int n) {
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i <= n; ++i) {
      points.push_back(point(static_cast<double>(i) / n) + Eigen::Vector2d(500000.0, 5500000.0));
    }
    s.tracks.push_back({std::move(id), points, s.tracks.size() + 1, {}, {}, {}});
  };
  line(
      "in", [](double u) { return Eigen::Vector2d(500.0 * u, 0.0); }, 10);
  line(
      "straight", [](double u) { return Eigen::Vector2d(500.0 + 200.0 * u, 50.0 * u); }, 10);
  line(
      "spiral",
      [](double u) {
        const double a = 2.0 * std::numbers::pi * u;
        return Eigen::Vector2d(500.0 + 400.0 * std::sin(a) + 200.0 * u, 400.0 * (1.0 - std::cos(a)) + 50.0 * u);
      },
      260);
  line(
      "out", [](double u) { return Eigen::Vector2d(700.0 + 800.0 * u, 50.0); }, 16);
  return std::make_unique<Map>(std::move(*network::build(s)));
}

/// 15 m/s from metre 100 on, fixes of 0.5 m in the open, speeds of an odometer that is 1 % too fast each second.
Recording drive(const Map& map, const std::string& way) {
  network::Path driven;
  for (const std::string& id : {std::string("in"), way, std::string("out")}) {
    for (network::TrackIndex t = 0; t < map.network.tracks.size(); ++t) {
      if (map.network.tracks[t].id == id) driven.push_back({t, false});
    }
  }
  const network::PathCoordinates path(map.network, driven);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.5);
  Recording r;
  for (int k = 0; 100.0 + 15.0 * k < path.length() - 50.0; ++k) {
    const double d = 100.0 + 15.0 * k;
    const Time t{static_cast<std::int64_t>(k) * 1'000'000'000};
    r.speed.samples.push_back({t, 15.15});
    if (d > path.starts()[1] - 20.0 && d < path.starts()[2] + 20.0) continue;
    const Eigen::Vector2d p = path.position(d) + Eigen::Vector2d(noise(random), noise(random));
    r.gnss.samples.push_back(Fix{t, map.network.to_geodetic(p), 0.5, 15.0, 0.1});
  }
  return r;
}

std::vector<std::string> ids(const Map& map, const PathSolution& p) {
  std::vector<std::string> out;
  for (const auto& t : p.coordinates.path()) out.push_back(map.network.tracks[t.track].id);
  return out;
}

TEST(Tunnel, AnOdometerTellsTheSpiralFromTheStraightWay) {
  const auto map = hill();
  for (const std::string way : {"spiral", "straight"}) {
    const auto result = georeference(*map, drive(*map, way), {});
    ASSERT_TRUE(result) << result.error().message();
    ASSERT_EQ(result->journeys.size(), 1u) << way;
    const auto& best = result->journeys[0].paths[0];
    EXPECT_EQ(ids(*map, best), (std::vector<std::string>{"in", way, "out"}));
    EXPECT_GT(best.probability, 0.99);
    // The odometer's 1 % over the spiral are 26 m until the first fix comes again; then it is GNSS that counts.
    const double end = 100.0 + 15.0 * static_cast<double>(result->journeys[0].steps - 1) * result->journeys[0].grid;
    EXPECT_NEAR(best.motion.distance.back(), end, 2.0);
  }
}

TEST(Tunnel, WithoutOdometerALongDetourIsNotInvented) {
  const auto map = hill();
  Recording r = drive(*map, "spiral");
  r.speed.samples.clear();
  const auto result = georeference(*map, r, {});
  ASSERT_TRUE(result);
  for (const auto& j : result->journeys) {
    const auto found = ids(*map, j.paths[0]);
    EXPECT_EQ(std::count(found.begin(), found.end(), "spiral"), 0);
  }
}

TEST(Tunnel, AnOdometerWithAGapTellsNoDistance) {
  const auto map = hill();
  Recording r = drive(*map, "spiral");
  auto& speeds = r.speed.samples;
  const auto middle = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2);
  speeds.erase(middle - 20, middle + 20);
  const auto result = georeference(*map, r, {});
  ASSERT_TRUE(result);
  for (const auto& j : result->journeys) {
    const auto found = ids(*map, j.paths[0]);
    EXPECT_EQ(std::count(found.begin(), found.end(), "spiral"), 0);
  }
}

}  // namespace
}  // namespace versine::georef
