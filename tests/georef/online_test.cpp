// SPDX-License-Identifier: Apache-2.0
#include "versine/georef/online.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>
#include <random>

#include "versine/network/build.hpp"

/// The online filter on a station's ladder of switches (six tracks 4.5 m apart), with known truth.
namespace versine::georef {
namespace {

constexpr double slope = 1.0 / 9.0;

std::unique_ptr<Map> ladder(int tracks) {
  network::NetworkSource s;
  s.file = "made";
  s.crs = "EPSG:32632";
  const auto line = [&](std::string id, Eigen::Vector2d a, Eigen::Vector2d b) {
    const Eigen::Vector2d origin(500000.0, 5500000.0);
    std::vector<Eigen::Vector2d> points;
    const int n = std::max(1, static_cast<int>((b - a).norm() / 20.0));
    for (int i = 0; i <= n; ++i) points.push_back(origin + a + (b - a) * (static_cast<double>(i) / n));
    s.tracks.push_back({std::move(id), points, s.tracks.size() + 1, {}, {}, {}});
  };
  const auto rung = [](int k) { return Eigen::Vector2d(600.0 + 4.5 * k / slope, 4.5 * k); };
  line("approach", {0.0, 0.0}, rung(0));
  line("p0", rung(0), {1800.0, 0.0});
  for (int k = 1; k < tracks; ++k) {
    line(fmt::format("l{}", k), rung(k - 1), rung(k));
    line(fmt::format("p{}", k), rung(k), {1800.0, 4.5 * k});
  }
  return std::make_unique<Map>(std::move(*network::build(s)));
}

network::Path path_to(const Map& map, const std::string& goal) {
  const auto find = [&](const std::string& id) {
    const auto& ts = map.network.tracks;
    return static_cast<network::TrackIndex>(std::find_if(ts.begin(), ts.end(), [&](auto& t) { return t.id == id; }) -
                                            ts.begin());
  };
  network::Path path{{find("approach"), false}};
  for (int k = 1; k <= goal[1] - '0'; ++k) path.push_back({find(fmt::format("l{}", k)), false});
  path.push_back({find(goal), false});
  return path;
}

struct Truth {
  Recording recording;
  std::vector<double> distance, speed;  // on the path, every 0.01 s; speed negative when it comes back
};

/// Stands, runs `far` metres along the path, stands, and comes back `back` metres. IMU 100 Hz, GNSS 5 Hz.
Truth drive(const Map& map, const network::Path& tracks, double far, double back, double sigma, unsigned seed,
            double gap_from = 1e9, double gap_to = 1e9, double from = 30.0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const network::PathCoordinates path(map.network, tracks);
  Truth out;
  double d = from, v = 0.0, still = 0.0, goal = far;
  Eigen::Vector2d colour(normal(random), normal(random));
  const double bias = 0.04 * normal(random);
  int leg = 0;
  for (int k = 0; k < 60'000 && leg < 3; ++k) {
    const double left = goal - d, direction = left < 0.0 ? -1.0 : 1.0;
    double a = 0.0;
    if (leg == 0 || leg == 2 || std::abs(left) < 0.05) {
      v = 0.0;
      if ((still += 0.01) > 20.0) {
        still = 0.0, ++leg;
        if (leg == 2) leg = back > 0.0 && goal == far ? (goal = far - back, 1) : 3;
      }
      if (leg == 1 && std::abs(goal - d) < 0.05 && still == 0.0) leg = 2;
    } else {
      const double speed = std::abs(v), limit = std::sqrt(2.0 * 0.5 * std::abs(left));
      a = direction * (speed > limit ? -0.55 : speed < 12.0 ? 0.45 : 0.0);
    }
    const Time t{static_cast<std::int64_t>(k) * 10'000'000};
    out.recording.imu.samples.push_back(
        {t, {a + bias + 0.1 * normal(random), 0.1 * normal(random), -9.81 + 0.1 * normal(random)}, {}});
    out.distance.push_back(d), out.speed.push_back(v);
    if (k % 20 == 0) {
      const double f = std::exp(-0.2 / 15.0);
      for (int i = 0; i < 2; ++i) colour[i] = f * colour[i] + std::sqrt(1.0 - f * f) * normal(random);
      const Eigen::Vector2d white(normal(random), normal(random));
      const Eigen::Vector2d e = sigma * (std::sqrt(0.8) * colour + std::sqrt(0.2) * white);
      Fix fix{t, map.network.to_geodetic(path.position(d) + e), sigma, std::abs(v + 0.1 * normal(random)), 0.1};
      if (0.01 * k < gap_from || 0.01 * k > gap_to) out.recording.gnss.samples.push_back(fix);
    }
    d += 0.01 * v + 0.5e-4 * a;
    v += 0.01 * a;
  }
  return out;
}

struct Replayed {
  std::vector<OnlinePosition> positions;
  std::vector<OnlineDecision> decisions;
  std::size_t restarts = 0;
};
Replayed replay(const Map& map, const Recording& r) {
  Options options;
  options.gnss.scale = 1.0;
  options.gnss.map_sigma = 0.1;
  options.gnss.speed_scale = 1.0;
  options.inference.diverging = 0.5;
  OnlineGeoreferencer live(map, options);
  Replayed out;
  std::size_t imu = 0;
  for (const auto& fix : r.gnss) {
    for (; imu < r.imu.size() && !(fix.time < r.imu[imu].time); ++imu) live.add(r.imu[imu], false);
    if (const auto p = live.add(fix)) out.positions.push_back(*p);
    for (const auto& d : live.take_decisions()) out.decisions.push_back(d);
  }
  out.restarts = live.restarts();
  return out;
}

double error_along(const Map& map, const network::Path& path, const Truth& truth, const OnlinePosition& p) {
  const network::PathCoordinates c(map.network, path);
  const double d = truth.distance[static_cast<std::size_t>(p.time.ns / 10'000'000)];
  return c.project(p.point).distance - d;
}

TEST(Online, LadderIsDecidedRightSoonAndHonestly) {
  const auto map = ladder(6);
  std::size_t legs = 0, wrong = 0, revised = 0, on_track = 0, inside = 0, positions = 0;
  double square = 0.0, brier = 0.0;
  std::vector<double> metres;
  for (int run = 0; run < 18; ++run) {
    const auto path = path_to(*map, fmt::format("p{}", run % 6));
    const auto truth = drive(*map, path, 1500.0, 0.0, 0.8, static_cast<unsigned>(run));
    const auto out = replay(*map, truth.recording);
    ASSERT_GT(out.positions.size(), 300u);
    EXPECT_EQ(out.restarts, 0u);
    for (const auto& d : out.decisions) {
      revised += d.revised ? 1 : 0;
      if (d.kind != OnlineDecision::Kind::leg) continue;
      ++legs;
      wrong += std::find(path.begin(), path.end(), d.to) == path.end() ? 1 : 0;
      metres.push_back(d.metres);
    }
    EXPECT_EQ(out.positions.back().track.track, path.back().track) << run;
    for (const auto& p : out.positions) {
      const double e = error_along(*map, path, truth, p);
      square += e * e, ++positions;
      inside += std::abs(e) < 1.96 * p.sigma ? 1 : 0;
      const bool right = std::any_of(path.begin(), path.end(), [&](auto& t) { return t.track == p.track.track; });
      on_track += right ? 1 : 0;
      brier += (p.probability - (right ? 1.0 : 0.0)) * (p.probability - (right ? 1.0 : 0.0));
    }
  }
  std::sort(metres.begin(), metres.end());
  const auto n = static_cast<double>(positions);
  fmt::print(
      "ladder: {} legs decided, {} wrong, {} revised, after {:.0f} m (median), {:.0f} m at worst; on the right track "
      "{:.2f} %, along-track RMS {:.2f} m, coverage {:.3f}, Brier score {:.4f}\n",
      legs, wrong, revised, metres[metres.size() / 2], metres.back(), 100.0 * static_cast<double>(on_track) / n,
      std::sqrt(square / n), static_cast<double>(inside) / n, brier / n);
  EXPECT_LE(wrong, legs / 50);
  EXPECT_GT(static_cast<double>(on_track) / n, 0.95);
  EXPECT_LT(std::sqrt(square / n), 0.8);
  EXPECT_GT(static_cast<double>(inside) / n, 0.85);
  EXPECT_LT(metres[metres.size() / 2], 150.0);
}

TEST(Online, ReversalIsFollowed) {
  const auto map = ladder(4);
  const auto path = path_to(*map, "p2");
  const auto truth = drive(*map, path, 1200.0, 700.0, 0.8, 5);
  const auto out = replay(*map, truth.recording);
  ASSERT_FALSE(out.positions.empty());
  const auto& last = out.positions.back();
  EXPECT_EQ(map->network.tracks[last.track.track].id, "approach");
  EXPECT_TRUE(last.track.reversed);
  EXPECT_LT(std::abs(error_along(*map, path, truth, last)), 3.0);
  EXPECT_TRUE(std::any_of(out.decisions.begin(), out.decisions.end(),
                          [](auto& d) { return d.kind == OnlineDecision::Kind::reversal; }));
  EXPECT_EQ(out.restarts, 0u);
}

TEST(Online, SilenceOverTheLadder) {
  const auto map = ladder(6);
  const auto path = path_to(*map, "p4");
  // From before the first switch until 70 s later, on the platform track.
  const auto truth = drive(*map, path, 1700.0, 0.0, 0.8, 7, 60.0, 130.0);
  const auto out = replay(*map, truth.recording);
  ASSERT_FALSE(out.positions.empty());
  EXPECT_EQ(map->network.tracks[out.positions.back().track.track].id, "p4");
  EXPECT_EQ(out.restarts, 0u);
}

TEST(Online, ADayOfShuttlingCostsNoMoreAnHour) {
  const auto map = ladder(6);
  const auto path = path_to(*map, "p4");
  // From the approach onto a platform track and back to the same place, standing at both ends: joined without a seam.
  const auto cycle = drive(*map, path, 1200.0, 700.0, 0.8, 11, 1e9, 1e9, 500.0).recording;
  const Duration length = cycle.imu.back().time - cycle.imu.front().time + Duration{10'000'000};
  OnlineGeoreferencer live(*map, {});
  std::vector<double> seconds;
  std::size_t lost = 0;
  const int cycles = 300;
  for (int c = 0; c < cycles; ++c) {
    const auto begin = std::clock();
    const Duration shift{length.ns * c};
    std::optional<OnlinePosition> last;
    std::size_t imu = 0;
    for (auto fix : cycle.gnss) {
      for (; imu < cycle.imu.size() && !(fix.time < cycle.imu[imu].time); ++imu) {
        auto sample = cycle.imu[imu];
        sample.time = sample.time + shift;
        live.add(sample, false);
      }
      fix.time = fix.time + shift;
      last = live.add(fix);
    }
    lost += last && map->network.tracks[last->track.track].id == "approach" ? 0 : 1;
    static_cast<void>(live.take_decisions());
    seconds.push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  const auto sum = [&](int from, int to) { return std::accumulate(seconds.begin() + from, seconds.begin() + to, 0.0); };
  fmt::print("shuttling for {:.0f} h: {:.2f} s of processor time, last third over first {:.2f}\n",
             length.seconds() * cycles / 3600.0, sum(0, cycles), sum(200, 300) / sum(0, 100));
  EXPECT_EQ(lost, 0u);
  EXPECT_EQ(live.restarts(), 0u);
  EXPECT_LT(sum(200, 300), 2.0 * sum(0, 100));
}

TEST(Online, MuchFasterThanTime) {
  const auto map = ladder(6);
  const auto truth = drive(*map, path_to(*map, "p3"), 1500.0, 0.0, 0.8, 3);
  const auto begin = std::clock();
  const auto out = replay(*map, truth.recording);
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  const double lasted = (truth.recording.gnss.back().time - truth.recording.gnss.front().time).seconds();
  fmt::print("online: {:.3f} s of processor time for {:.0f} s of recording\n", seconds, lasted);
  EXPECT_LT(seconds, 0.05 * lasted);
}

}  // namespace
}  // namespace versine::georef
