// SPDX-License-Identifier: Apache-2.0
#include "online_paths.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>
#include <unordered_set>

namespace versine::georef {

namespace {
constexpr std::uint32_t no_parent = 0xFFFFFFFFU;

struct Label {
  network::OrientedTrack track;
  double length = 0.0, prior = 0.0;  // to the end of `track`
  std::uint32_t parent = no_parent;
};

double leg_prior(const std::span<const network::OrientedGraph::Arc> arcs, bool diverging, double probability) {
  if (arcs.size() < 2) return 0.0;
  return diverging ? std::log(probability / static_cast<double>(arcs.size() - 1)) : std::log1p(-probability);
}

WayOn collect(const std::vector<Label>& labels, std::uint32_t id) {
  WayOn way{{}, labels[id].prior};
  for (std::uint32_t l = id; l != no_parent; l = labels[l].parent) way.tracks.push_back(labels[l].track);
  std::reverse(way.tracks.begin(), way.tracks.end());
  return way;
}

/// Labels in order of `better`, each handed to `visit`, which tells whether to go on behind it.
template <class Better, class Visit>
void explore(const Map& map, network::OrientedTrack from, double diverging, std::vector<Label>& labels, Better better,
             Visit visit) {
  const auto worse = [&](std::uint32_t a, std::uint32_t b) { return better(labels[b], labels[a]); };
  std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, decltype(worse)> queue(worse);
  const auto leave = [&](network::OrientedTrack track, double length, double prior, std::uint32_t parent) {
    const auto arcs = map.graph.successors(track);
    for (const auto& arc : arcs) {
      labels.push_back(
          {arc.to, length + map.graph.length(arc.to), prior + leg_prior(arcs, arc.diverging, diverging), parent});
      queue.push(static_cast<std::uint32_t>(labels.size() - 1));
    }
  };
  leave(from, 0.0, 0.0, no_parent);
  while (!queue.empty() && labels.size() < 200'000) {
    const std::uint32_t id = queue.top();
    queue.pop();
    if (visit(id)) leave(labels[id].track, labels[id].length, labels[id].prior, id);
  }
}
}  // namespace

std::vector<WayOn> ways_on(const Map& map, network::OrientedTrack track, double metres, double diverging,
                           std::size_t most) {
  std::vector<WayOn> out;
  std::vector<Label> labels;
  explore(
      map, track, diverging, labels, [](const Label& a, const Label& b) { return a.prior > b.prior; },
      [&](std::uint32_t id) {
        if (out.size() >= most) return false;
        if (labels[id].length < metres && !map.graph.successors(labels[id].track).empty()) return true;
        out.push_back(collect(labels, id));
        return false;
      });
  return out;
}

std::vector<WayOn> ways_to(const Map& map, network::OrientedTrack track, double metres, const Eigen::Vector2d& place,
                           double radius, double diverging, std::size_t most) {
  std::unordered_set<network::TrackIndex> targets;
  for (const auto& hit : map.index.near(place, radius)) targets.insert(hit.track);
  std::vector<WayOn> out;
  std::vector<Label> labels;
  std::unordered_map<std::uint32_t, int> visits;
  explore(
      map, track, diverging, labels, [](const Label& a, const Label& b) { return a.length < b.length; },
      [&](std::uint32_t id) {
        const Label label = labels[id];
        if (out.size() >= most || ++visits[label.track.state()] > 2) return false;
        if (label.length - map.graph.length(label.track) > metres) return false;
        if (targets.contains(label.track.track)) out.push_back(collect(labels, id));
        return true;
      });
  return out;
}

}  // namespace versine::georef
