// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <queue>

#include "versine/network/oriented_graph.hpp"
#include "versine/simulation/journey.hpp"

namespace versine::simulation {

namespace {
using network::OrientedTrack;

/// Distance from the end where an oriented track is entered.
double along(const network::Network& network, OrientedTrack t, double distance) {
  return t.reversed ? network.tracks[t.track].line.length() - distance : distance;
}

Expected<network::TrackIndex> track_named(const network::Network& network, const JourneyStop& stop) {
  for (std::size_t i = 0; i < network.tracks.size(); ++i) {
    if (network.tracks[i].id != stop.track) continue;
    if (stop.distance >= 0.0 && stop.distance <= network.tracks[i].line.length()) {
      return static_cast<network::TrackIndex>(i);
    }
    return fail({.field = "distance_m",
                 .found = fmt::format("{} m on track '{}'", stop.distance, stop.track),
                 .expected = fmt::format("0 to {:.1f} m, its length", network.tracks[i].line.length()),
                 .advice = "stop on the track"});
  }
  return fail({.field = "track",
               .found = fmt::format("'{}'", stop.track),
               .expected = fmt::format("one of the network's {} tracks, such as '{}'", network.tracks.size(),
                                       network.tracks.empty() ? "" : network.tracks.front().id),
               .advice = "take an id of the map; lines that were split are named 'id[1]', 'id[2]'"});
}
}  // namespace

Expected<Movement> find_way(const network::Network& network, const JourneyStop& from, const JourneyStop& to) {
  const auto first = track_named(network, from);
  if (!first) return tl::unexpected(first.error());
  const auto last = track_named(network, to);
  if (!last) return tl::unexpected(last.error());
  if (*first == *last && from.distance != to.distance) {
    const OrientedTrack t{*first, to.distance < from.distance};
    return Movement{{t}, along(network, t, from.distance), along(network, t, to.distance), 0};
  }
  // Dijkstra over oriented tracks; the cost of a state is the way to the end where it is entered.
  const network::OrientedGraph graph(network);
  constexpr double never = std::numeric_limits<double>::infinity();
  std::vector<double> cost(graph.states(), never);
  std::vector<std::int64_t> before(graph.states(), -1);
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (const bool reversed : {false, true}) {
    const OrientedTrack t{*first, reversed};
    cost[t.state()] = -along(network, t, from.distance);  // the part behind the vehicle is not driven
    open.emplace(cost[t.state()], t.state());
  }
  double best = never;
  std::uint32_t found = 0;
  while (!open.empty()) {
    const auto [c, state] = open.top();
    open.pop();
    if (c > cost[state] || c > best) continue;
    const OrientedTrack t = OrientedTrack::from_state(state);
    if (t.track == *last && before[state] >= 0 && c + along(network, t, to.distance) < best) {
      best = c + along(network, t, to.distance);
      found = state;
    }
    for (const auto& arc : graph.successors(t)) {
      const double next = c + graph.length(t);
      if (next >= cost[arc.to.state()]) continue;
      cost[arc.to.state()] = next;
      before[arc.to.state()] = state;
      open.emplace(next, arc.to.state());
    }
  }
  if (best == never) {
    return fail({.field = "track",
                 .found = fmt::format("no way from '{}' to '{}' without reversing between", from.track, to.track),
                 .expected = "a way that wheels can go",
                 .advice = "add a stop where the vehicle reverses, behind the switch"});
  }
  Movement movement;
  for (std::int64_t s = found; s >= 0; s = before[static_cast<std::size_t>(s)]) {
    movement.path.push_back(OrientedTrack::from_state(static_cast<std::uint32_t>(s)));
  }
  std::reverse(movement.path.begin(), movement.path.end());
  movement.from = along(network, movement.path.front(), from.distance);
  double ahead = 0.0;
  for (std::size_t i = 0; i + 1 < movement.path.size(); ++i) ahead += graph.length(movement.path[i]);
  movement.to = ahead + along(network, movement.path.back(), to.distance);
  return movement;
}

}  // namespace versine::simulation
