// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "versine/georef/georeference.hpp"
#include "versine/network/build.hpp"

/// Journeys with known truth on a made network.
namespace versine::georef {

/// `crossings` scissors crossovers, 4.5 m between the lines, 400 m from one to the next.
inline network::NetworkSource scissors_chain(int crossings) {
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
  Recording recording;  // with turn rates free of errors; has_turn_rate is not set
  network::Path path;
  std::vector<double> distance;  // every 0.01 s
};

inline Simulated simulate(const Map& map, std::mt19937& random, double seconds, double sigma) {
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
    const double yaw_rate = v * (path.azimuth(d + 0.5, 20.0) - path.azimuth(d - 0.5, 20.0));
    s.recording.imu.samples.push_back(
        {t,
         {a + bias + slope + 0.3 * normal(random), 0.3 * normal(random), -9.81 + 0.3 * normal(random)},
         {0.0, 0.0, yaw_rate}});
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

inline std::unique_ptr<Map> chain(int crossings) {
  return std::make_unique<Map>(std::move(*network::build(scissors_chain(crossings))));
}

inline Options honest() {
  Options o;
  o.gnss.scale = 1.0;
  o.gnss.map_sigma = 0.1;
  o.gnss.speed_scale = 1.0;
  o.inference.diverging = 0.5;
  return o;
}

/// Whether a path is the one driven, where the vehicle was.
inline bool is_driven(const PathSolution& p, const network::Path& driven) {
  const auto& found = p.coordinates.path();
  return std::search(driven.begin(), driven.end(), found.begin(), found.end()) != driven.end();
}

}  // namespace versine::georef
