// SPDX-License-Identifier: Apache-2.0
#include "versine/georef/stamping.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "versine/georef/monitoring.hpp"
#include "versine/network/build.hpp"

/// Stamping on a result made by hand, so that every position is known in closed form: 0.5 m/s^2 from rest on a track,
/// over a joint, onto a track that is run through against its points.
namespace versine::georef {
namespace {

constexpr double acceleration = 0.5;

std::unique_ptr<Map> two_tracks() {
  network::NetworkSource s;
  s.file = "made";
  s.crs = "EPSG:32632";
  const Eigen::Vector2d origin(500000.0, 5500000.0);
  const auto line = [&](std::string id, double from, double to) {
    s.tracks.push_back({std::move(id),
                        {origin + Eigen::Vector2d(from, 0.0), origin + Eigen::Vector2d(to, 0.0)},
                        s.tracks.size() + 1,
                        {},
                        {},
                        {}});
  };
  line("first", 0.0, 500.0);
  line("second", 2000.0, 500.0);
  return std::make_unique<Map>(std::move(*network::build(s)));
}

RecordingResult accelerating(const Map& map, double seconds) {
  RecordingResult r;
  JourneyResult j;
  j.start = Time::from_seconds(1000.0);
  j.grid = 0.01;
  j.steps = static_cast<std::size_t>(seconds / j.grid) + 1;
  PathSolution p;
  p.coordinates = network::PathCoordinates(map.network, {{0, false}, {1, true}});
  p.probability = 0.9;
  for (std::size_t k = 0; k < j.steps; ++k) {
    const double t = 0.01 * static_cast<double>(k);
    p.motion.distance.push_back(0.5 * acceleration * t * t);
    p.motion.speed.push_back(static_cast<float>(acceleration * t));
    p.motion.sigma_distance.push_back(0.3F);
    p.motion.sigma_speed.push_back(0.1F);
  }
  j.paths.push_back(std::move(p));
  r.journeys.push_back(std::move(j));
  return r;
}

/// Ground metres: the projection's scale at its middle meridian is 0.9996.
double ground(const Map& map, std::size_t track) {
  return map.network.tracks[track].line.length();
}

TEST(Stamping, PositionsAreThoseOfTheMovement) {
  const auto map = two_tracks();
  const auto result = accelerating(*map, 80.0);
  PositionCursor cursor(*map, result);
  EXPECT_FALSE(cursor.at(Time::from_seconds(999.9)));
  EXPECT_FALSE(cursor.at(Time::from_seconds(1080.1)));
  for (const double t : {0.0, 3.3337, 44.0, 44.8, 44.9, 70.12345, 12.0, 80.0}) {  // forwards and back again
    const auto p = cursor.at(Time::from_seconds(1000.0 + t));
    ASSERT_TRUE(p) << t;
    const double d = 0.5 * acceleration * t * t, joint = ground(*map, 0);
    EXPECT_NEAR(p->path_distance, d, 1e-4);
    EXPECT_EQ(map->network.tracks[p->track.track].line_id, d < joint ? "first" : "second");
    EXPECT_NEAR(p->track_distance, d < joint ? d : ground(*map, 1) - (d - joint), 1e-4);
    EXPECT_NEAR(p->speed, acceleration * t, 1e-3);
    EXPECT_DOUBLE_EQ(p->probability, 0.9);
    EXPECT_NEAR((p->point - map->network.tracks[0].line.points().front()).norm(), 0.9996 * d, 0.02);
  }
}

/// 20 kHz in blocks of odd sizes; channel 0 a sine of known RMS, channel 1 an impulse at known places.
struct Fed {
  std::vector<StampRow> table, positions;
  std::vector<BinRow> bins;
};
Fed feed(const Map& map, const RecordingResult& result, const MonitoringOptions& options,
         const std::vector<double>& joints, std::size_t block_size) {
  MonitoringStamper stamper(map, result, 2, options);
  Fed fed;
  const auto take = [&] {
    fed.table.insert(fed.table.end(), stamper.table.begin(), stamper.table.end());
    fed.positions.insert(fed.positions.end(), stamper.positions.begin(), stamper.positions.end());
    fed.bins.insert(fed.bins.end(), stamper.bins.begin(), stamper.bins.end());
    stamper.table.clear(), stamper.positions.clear(), stamper.bins.clear();
  };
  const std::size_t n = 20000 * 85;
  std::size_t next_joint = 0;
  for (std::size_t i = 0; i < n;) {
    SampleBlock block;
    block.first = i;
    block.channels.resize(2);
    for (const std::size_t end = std::min(n, i + block_size); i < end; ++i) {
      // The file begins 2 s before the journey.
      const double t = static_cast<double>(i) / 20000.0 - 2.0, d = t > 0.0 ? 0.5 * acceleration * t * t : 0.0;
      block.times.push_back(Time{998'000'000'000 + static_cast<std::int64_t>(i) * 50'000});
      block.channels[0].push_back(static_cast<float>(3.0 * std::sin(2.0 * M_PI * 400.0 * t)));
      const bool hit = next_joint < joints.size() && d >= joints[next_joint];
      next_joint += hit ? 1 : 0;
      block.channels[1].push_back(hit ? -50.0F : 0.1F);
    }
    stamper.add(block);
    take();
  }
  stamper.finish();
  take();
  return fed;
}

TEST(Stamping, RmsAndPeakOfEachMetre) {
  const auto map = two_tracks();
  const auto result = accelerating(*map, 80.0);
  const std::vector<double> joints{100.25, 300.75, 1200.5};
  const auto fed = feed(*map, result, {.slowest = 5.0}, joints, 60000);
  const double joint = ground(*map, 0), length = ground(*map, 1);
  std::map<std::string, std::size_t> rows;
  std::vector<double> peaks;
  for (const auto& b : fed.bins) {
    const auto& id = map->network.tracks[b.track].line_id;
    ++rows[id];
    EXPECT_NEAR(b.to - b.from, 1.0, 1e-9);
    if (b.samples > 400) {
      EXPECT_NEAR(b.channels[0].rms, 3.0 / std::sqrt(2.0), 0.06);
    }
    EXPECT_GE(b.speed, 5.0);
    // The bin's middle was passed at the speed that belongs to it.
    const double middle = 0.5 * (b.from + b.to), d = id == "first" ? middle : joint + length - middle;
    EXPECT_NEAR(b.speed, std::sqrt(2.0 * acceleration * d), 0.06) << id << " " << b.from;
    if (b.channels[1].peak < -1.0) {
      const double at = b.channels[1].peak_at;
      EXPECT_GE(at, b.from - 1e-6);
      EXPECT_LE(at, b.to + 1e-6);
      peaks.push_back(id == "first" ? at : joint + length - at);
    }
  }
  ASSERT_EQ(peaks.size(), joints.size());
  for (std::size_t i = 0; i < joints.size(); ++i) EXPECT_NEAR(peaks[i], joints[i], 0.003);  // 40 m/s / 20 kHz
  // From 25 m, where 5 m/s is reached, to 500 m, and 1,100 m of the second track.
  EXPECT_NEAR(static_cast<double>(rows["first"]), joint - 25.0, 2.0);
  EXPECT_NEAR(static_cast<double>(rows["second"]), 1600.0 - joint, 2.0);
}

TEST(Stamping, TableInterpolatedLinearlyIsTheMovement) {
  const auto map = two_tracks();
  const auto result = accelerating(*map, 80.0);
  const auto fed = feed(*map, result, {.position_rate = 50.0}, {}, 65536);
  ASSERT_GT(fed.table.size(), 100u);
  EXPECT_LT(fed.table.size(), 1500u);  // not a row a sample
  for (std::size_t k = 0; k + 1 < fed.table.size(); ++k) {
    const auto &p = fed.table[k], &q = fed.table[k + 1];
    ASSERT_LT(p.time, q.time);
    EXPECT_NEAR(p.sample, (p.time.seconds() - 998.0) * 20000.0, 1e-2);
    if (p.position.track != q.position.track) {
      EXPECT_LT((q.time - p.time).seconds(), 1e-5);
      continue;
    }
    for (const double u : {0.25, 0.5, 0.75}) {
      const double t = (1.0 - u) * (p.time.seconds() - 1000.0) + u * (q.time.seconds() - 1000.0);
      const double d = (1.0 - u) * p.position.path_distance + u * q.position.path_distance;
      EXPECT_NEAR(d, 0.5 * acceleration * t * t, 1.3e-3);
    }
  }
  EXPECT_NEAR(fed.table.front().time.seconds(), 1000.0, 1e-4);
  EXPECT_NEAR(fed.table.back().time.seconds(), 1080.0, 1e-4);
  EXPECT_NEAR(static_cast<double>(fed.positions.size()), 80.0 * 50.0, 2.0);
  // Cut into other blocks the rows are the same.
  const auto other = feed(*map, result, {.position_rate = 50.0}, {}, 997);
  ASSERT_EQ(other.table.size(), fed.table.size());
  ASSERT_EQ(other.bins.size(), fed.bins.size());
  for (std::size_t k = 0; k < fed.bins.size(); ++k) {
    EXPECT_EQ(other.bins[k].samples, fed.bins[k].samples);
    EXPECT_EQ(other.bins[k].channels[0].rms, fed.bins[k].channels[0].rms);
  }
}

}  // namespace
}  // namespace versine::georef
