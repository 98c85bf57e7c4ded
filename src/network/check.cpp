// SPDX-License-Identifier: Apache-2.0
#include "versine/network/check.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "versine/network/oriented_graph.hpp"
#include "versine/network/spatial_index.hpp"

namespace versine::network {

namespace {

void check_joint(const Network& n, const OrientedGraph& g, const Joint& j, MapCheck& out) {
  const std::string& id = n.tracks[j.ends.front().track].id;
  if (j.spread > 1e-3) out.findings.push_back({"near miss", j.place, id, j.spread});
  if (j.ends.size() == 1 && j.kind != NodeKind::buffer_stop) out.findings.push_back({"dead end", j.place, id, 0.0});
  if (j.ends.size() == 4 && !j.labelled && j.kind != NodeKind::crossing && j.kind != NodeKind::slip) {
    out.findings.push_back({"unlabelled four-armed node", j.place, id, 0.0});
  }
  std::size_t most = 0;
  for (const auto& e : j.ends) {
    const OrientedTrack leaving{e.track, e.end == End::begin};
    const auto ways = g.successors(leaving).size();
    most = std::max(most, ways);
    if (ways == 0 && j.ends.size() > 1) out.findings.push_back({"no way through", j.place, n.tracks[e.track].id, 0.0});
  }
  if (j.ends.size() == 3 && most == 2) ++out.switches;
}

/// A line drawn twice: every place of the track lies within half a metre of one and the same other track. The middle
/// comes first, since hardly any track passes even there.
void check_duplicates(const Network& n, MapCheck& out) {
  constexpr double near = 0.5, step = 50.0;
  const SpatialIndex index(n);
  for (TrackIndex t = 0; t < n.tracks.size(); ++t) {
    const auto& line = n.tracks[t].line;
    if (line.length() < 5.0) continue;
    for (const auto& hit : index.near(line.position(0.5 * line.length()), near)) {
      if (hit.track >= t) continue;  // each pair once
      const auto& other = n.tracks[hit.track].line;
      const int samples = std::max(4, static_cast<int>(line.length() / step));
      bool along = true;
      for (int i = 0; along && i <= samples; ++i) {
        along = other.project(line.position(line.length() * i / samples)).offset < near;
      }
      if (along)
        out.findings.push_back({"duplicated track", line.position(0.5 * line.length()), n.tracks[t].id, line.length()});
    }
  }
}

void check_pieces(const Network& n, MapCheck& out) {
  std::vector<std::uint32_t> parent(n.tracks.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto find = [&](std::uint32_t x) {
    while (parent[x] != x) x = parent[x] = parent[parent[x]];
    return x;
  };
  for (const auto& c : n.connections) parent[find(c.from.track)] = find(c.to.track);
  std::vector<double> length(n.tracks.size(), 0.0);
  for (std::uint32_t t = 0; t < n.tracks.size(); ++t) length[find(t)] += n.tracks[t].line.length();
  const double largest = *std::max_element(length.begin(), length.end());
  for (std::uint32_t t = 0; t < n.tracks.size(); ++t) {
    if (find(t) != t) continue;
    ++out.pieces;
    if (length[t] < largest) {
      out.findings.push_back({"isolated piece", n.tracks[t].line.points().front(), n.tracks[t].id, length[t]});
    }
  }
}

}  // namespace

MapCheck check(const Network& n, double kink) {
  MapCheck out;
  const OrientedGraph g(n);
  for (const auto& j : n.joints) check_joint(n, g, j, out);
  for (const auto& t : n.tracks) {
    out.length += t.line.length();
    const auto& p = t.line.points();
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
      const Eigen::Vector2d a = p[i] - p[i - 1], b = p[i + 1] - p[i];
      const double angle = std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
      if (angle > kink) out.findings.push_back({"kink", p[i], t.id, angle});
    }
  }
  check_duplicates(n, out);
  check_pieces(n, out);
  return out;
}

}  // namespace versine::network
