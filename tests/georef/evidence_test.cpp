// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "simulated.hpp"

/// What decides between paths, and what the vehicle's sensors add.
namespace versine::georef {
namespace {

/// Root mean square of the difference of two results' distances, taken along the line.
double difference(const RecordingResult& a, const RecordingResult& b) {
  double sum = 0.0, n = 0.0;
  for (const auto& fix : a.fixes) {
    const auto p = stamp(a, fix.time), q = stamp(b, fix.time);
    if (!p.valid || !q.valid) continue;
    sum += std::pow(p.distance - q.distance, 2), n += 1.0;
  }
  return std::sqrt(sum / n);
}

TEST(Evidence, TurnRateTellsTheLegsOfSwitchesApart) {
  const auto map = chain(4);
  std::mt19937 random(11);
  int with = 0, without = 0;
  double decided = 0.0;
  const int runs = 8;
  for (int run = 0; run < runs; ++run) {
    auto s = simulate(*map, random, 200.0, 5.0);
    const auto blind = georeference(*map, s.recording, honest());
    s.recording.has_turn_rate = true;
    const auto seeing = georeference(*map, s.recording, honest());
    ASSERT_TRUE(blind && seeing);
    without += is_driven(blind->journeys[0].paths[0], s.path);
    with += is_driven(seeing->journeys[0].paths[0], s.path);
    for (const auto& a : seeing->journeys[0].ambiguous) decided = std::max(decided, a.evidence.turn_rate);
    EXPECT_EQ(blind->journeys[0].paths[0].evidence.turn_rate, 0.0);
  }
  fmt::print("right paths with turn rate {}/{}, without {}/{}\n", with, runs, without, runs);
  EXPECT_GE(with, runs - 1);
  EXPECT_GT(with, without);
}

TEST(Evidence, AmbiguousStretchesAddUp) {
  const auto map = chain(3);
  std::mt19937 random(12);
  const auto s = simulate(*map, random, 150.0, 6.0);
  const auto result = georeference(*map, s.recording, honest());
  ASSERT_TRUE(result);
  const auto& j = result->journeys[0];
  ASSERT_GT(j.paths.size(), 1u);
  ASSERT_FALSE(j.ambiguous.empty());
  double sum = 0.0;
  for (const auto& p : j.paths) sum += p.probability;
  EXPECT_NEAR(sum, 1.0, 1e-9);
  for (const auto& a : j.ambiguous) {
    double p = 0.0;
    for (const auto k : a.paths) p += j.paths[k].probability;
    EXPECT_NEAR(p, a.probability, 1e-12);
    EXPECT_NE(a.taken, a.alternative);
    EXPECT_LE(a.from, a.to);
    EXPECT_NEAR(std::log(j.paths[0].probability / j.paths[a.paths[0]].probability), a.evidence.total(), 0.7);
  }
}

TEST(Evidence, UnscentedAndCentralDifferenceAgree) {
  const auto map = chain(4);
  std::mt19937 random(13);
  const auto s = simulate(*map, random, 200.0, 1.0);
  Options options = honest();
  const auto central = georeference(*map, s.recording, options);
  options.linearisation = Linearisation::unscented;
  const auto unscented = georeference(*map, s.recording, options);
  ASSERT_TRUE(central && unscented);
  EXPECT_EQ(central->journeys[0].paths[0].coordinates.path(), unscented->journeys[0].paths[0].coordinates.path());
  EXPECT_LT(difference(*central, *unscented), 0.05);
  EXPECT_GT(difference(*central, *unscented), 0.0);
}

TEST(Imu, ForwardAxisIsFoundHoweverItIsMounted) {
  const auto map = chain(4);
  std::mt19937 random(14);
  auto s = simulate(*map, random, 200.0, 1.0);
  s.recording.has_turn_rate = true;
  const auto straight = georeference(*map, s.recording, honest());
  const Eigen::Quaterniond q(Eigen::AngleAxisd(2.1, Eigen::Vector3d(0.3, -0.2, 0.9).normalized()));
  for (auto& x : s.recording.imu.samples) x.acceleration = q * x.acceleration, x.turn_rate = q * x.turn_rate;
  const auto turned = georeference(*map, s.recording, honest());
  Options given = honest();
  given.forward_axis = q * Eigen::Vector3d::UnitX();
  const auto told = georeference(*map, s.recording, given);
  ASSERT_TRUE(straight && turned && told);
  EXPECT_LT(difference(*straight, *turned), 0.05);
  EXPECT_LT(difference(*told, *turned), 0.1);
}

TEST(Gnss, AnErrorThatBeginsUnderABridgeDoesNotMoveTheVehicle) {
  const auto map = chain(4);
  std::mt19937 random(15);
  double square = 0.0, n = 0.0;
  for (int run = 0; run < 6; ++run) {
    auto s = simulate(*map, random, 200.0, 0.7);
    const auto clean = georeference(*map, s.recording, honest());
    // 6 m along the line for 15 s, and the receiver does not notice.
    for (auto& f : s.recording.gnss.samples) {
      if (f.time.seconds() < 80.0 || f.time.seconds() > 95.0) continue;
      f.position = map->network.to_geodetic(map->network.to_map(f.position) + Eigen::Vector2d(6.0, 0.0));
    }
    const auto bridge = georeference(*map, s.recording, honest());
    ASSERT_TRUE(clean && bridge);
    for (double t = 80.0; t < 95.0; t += 1.0) {
      const double e = stamp(*bridge, Time::from_seconds(t)).distance - stamp(*clean, Time::from_seconds(t)).distance;
      square += e * e, n += 1.0;
    }
  }
  fmt::print("6 m of multipath move the vehicle by {:.2f} m RMS\n", std::sqrt(square / n));
  EXPECT_LT(std::sqrt(square / n), 0.6);
}

TEST(Chaining, TheEndOfAJourneyIsThePriorOfTheNext) {
  const auto map = chain(1);
  std::vector<Knot> knots;
  for (int i = 0; i < 14; ++i) {  // midway between both lines
    const double x = 20.0 + 20.0 * i;
    knots.push_back({{static_cast<std::int64_t>(i) * 2'000'000'000},
                     Eigen::Vector2d(500000.0 + x, 5500000.0 + 60.0 * std::sin(x / 500.0) + 2.25) - map->network.origin,
                     2.0,
                     1.0,
                     -1.0});
  }
  for (const char* id : {"a0", "b0"}) {
    const auto it =
        std::find_if(map->network.tracks.begin(), map->network.tracks.end(), [&](const auto& t) { return t.id == id; });
    const StartPlace start{static_cast<network::TrackIndex>(it - map->network.tracks.begin()), 20.0, 1.0, 1.0};
    const auto found = infer_paths(*map, knots, {}, {}, std::span(&start, 1));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(map->network.tracks[found[0].hypotheses[0].path.front().track].id, id);
    EXPECT_GT(found[0].hypotheses[0].prior, found[0].hypotheses[1].prior);
  }
}

TEST(Chaining, ThereAndBackAreTwoJourneys) {
  const auto map = chain(2);
  std::mt19937 random(16);
  const auto s = simulate(*map, random, 120.0, 1.0);
  // Backwards in time after a minute of standing: the same way back.
  auto r = s.recording;
  const Time last = r.gnss.back().time;
  for (std::size_t i = s.recording.gnss.size(); i-- > 0;) {
    auto f = s.recording.gnss[i];
    f.time = last + Duration{200'000'000 + last.ns - f.time.ns};
    r.gnss.samples.push_back(f);
  }
  r.imu.samples.clear();
  const auto result = georeference(*map, r, honest());
  ASSERT_TRUE(result);
  ASSERT_EQ(result->journeys.size(), 2u);
  auto back = result->journeys[1].paths[0].coordinates.path();
  std::reverse(back.begin(), back.end());
  for (auto& t : back) t = t.opposite();
  EXPECT_EQ(back, result->journeys[0].paths[0].coordinates.path());
  EXPECT_LT(result->journeys[1].paths[0].evidence.route, 0.0);
}

}  // namespace
}  // namespace versine::georef
