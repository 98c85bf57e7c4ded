// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/network_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace versine::simulation {

namespace {
using Eigen::Vector2d;
constexpr double turnout = 60.0;  ///< length in which a turnout reaches the next track, m

/// Draws tracks in metres east and north of the layout's origin.
class Drawing {
 public:
  explicit Drawing(const NetworkLayout& layout) : origin_(layout.easting, layout.northing) {
    source_.file = "made by versine simulate";
    source_.crs = layout.crs;
  }
  /// From one side position to another between two distances, with no angle at the ends.
  void run(std::string id, double from, double to, double side_from, double side_to) {
    const int n = std::max(2, static_cast<int>(std::ceil((to - from) / 5.0)) + 1);
    std::vector<Vector2d> points;
    for (int i = 0; i < n; ++i) {
      const double u = static_cast<double>(i) / (n - 1);
      const double s = u * u * (3.0 - 2.0 * u);
      points.emplace_back(from + u * (to - from), side_from + s * (side_to - side_from));
    }
    add(std::move(id), std::move(points));
  }
  /// A quarter turn to the south from (x, y), east- or westbound.
  void quarter(std::string id, double x, double y, double radius, double direction) {
    std::vector<Vector2d> points;
    const int n = static_cast<int>(std::ceil(radius * 0.5 * std::numbers::pi / 5.0)) + 1;
    for (int i = 0; i < n; ++i) {
      const double angle = 0.5 * std::numbers::pi * i / (n - 1);
      points.emplace_back(x + direction * radius * std::sin(angle), y - radius * (1.0 - std::cos(angle)));
    }
    add(std::move(id), std::move(points));
  }
  void add(std::string id, std::vector<Vector2d> points) {
    for (Vector2d& p : points) p += origin_;
    source_.tracks.push_back({std::move(id), std::move(points), source_.tracks.size() + 1, {}, {}, {}});
  }
  [[nodiscard]] network::NetworkSource take() { return std::move(source_); }

 private:
  Vector2d origin_;
  network::NetworkSource source_;
};

/// The pieces of a straight track between its switches: "A1", "A2", ...
void straight(Drawing& drawing, const std::string& name, std::vector<double> places, double side) {
  std::sort(places.begin(), places.end());
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    drawing.run(fmt::format("{}{}", name, i + 1), places[i], places[i + 1], side, side);
  }
}

/// Ladder: track k leaves track k - 1 (0 is B) and runs to the ladder at the other end.
void station(Drawing& drawing, const NetworkLayout& layout, double west, double east, std::vector<double>& b_places) {
  const double step = turnout + 10.0, first = layout.spacing;
  for (int k = 1; k <= layout.station_tracks; ++k) {
    const double below = first + layout.spacing * (k - 1), side = first + layout.spacing * k;
    const double leave = west + step * (k - 1), meet = east - step * (k - 1);
    drawing.run(fmt::format("L{}", k), leave, leave + turnout, below, side);
    drawing.run(fmt::format("R{}", k), meet - turnout, meet, side, below);
    if (k == 1) b_places.insert(b_places.end(), {leave, meet});
    // The next ladder's switches split this track.
    const bool last = k == layout.station_tracks;
    const double inner_west = leave + step, inner_east = meet - step;
    if (last) {
      drawing.run(fmt::format("S{}", k), leave + turnout, meet - turnout, side, side);
    } else {
      drawing.run(fmt::format("S{}w", k), leave + turnout, inner_west, side, side);
      drawing.run(fmt::format("S{}", k), inner_west, inner_east, side, side);
      drawing.run(fmt::format("S{}e", k), inner_east, meet - turnout, side, side);
    }
  }
}
}  // namespace

network::NetworkSource make_network(const NetworkLayout& layout) {
  Drawing drawing(layout);
  std::vector<double> a{0.0, layout.length}, b{0.0, layout.length};
  double x = 400.0;
  for (int k = 1; k <= layout.crossovers; ++k, x += 460.0) {
    for (auto* places : {&a, &b}) places->insert(places->end(), {x, x + turnout});
    drawing.run(fmt::format("X{}ab", k), x, x + turnout, 0.0, layout.spacing);
    drawing.run(fmt::format("X{}ba", k), x, x + turnout, layout.spacing, 0.0);
  }
  if (layout.station_tracks > 0) {
    station(drawing, layout, x, x + 600.0 + 140.0 * layout.station_tracks, b);
    x += 700.0 + 140.0 * layout.station_tracks;
  }
  // A siding behind a switch of B, ending at a buffer stop.
  b.push_back(x);
  drawing.run("D0", x, x + turnout, layout.spacing, 2.0 * layout.spacing);
  drawing.run("D", x + turnout, x + turnout + 250.0, 2.0 * layout.spacing, 2.0 * layout.spacing);
  if (layout.triangle) {
    constexpr double radius = 190.0;
    const double west = x + 100.0, east = west + 2.0 * radius;
    a.insert(a.end(), {west, east});
    drawing.quarter("T1", west, 0.0, radius, 1.0);
    drawing.quarter("T2", east, 0.0, radius, -1.0);
    std::vector<Vector2d> stem;
    for (double y = 0.0; y <= 300.0; y += 10.0) stem.emplace_back(west + radius, -radius - y);
    drawing.add("T", std::move(stem));
  }
  straight(drawing, "A", std::move(a), 0.0);
  straight(drawing, "B", std::move(b), layout.spacing);
  return drawing.take();
}

}  // namespace versine::simulation
