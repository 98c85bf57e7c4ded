// SPDX-License-Identifier: Apache-2.0
#include "versine/network/oriented_graph.hpp"

#include <algorithm>

namespace versine::network {

OrientedGraph::OrientedGraph(const Network& network) : first_(2 * network.tracks.size() + 1, 0) {
  for (const auto& c : network.connections) ++first_[c.from.state() + 1];
  for (std::size_t s = 1; s < first_.size(); ++s) first_[s] += first_[s - 1];
  arcs_.reserve(network.connections.size());
  for (const auto& c : network.connections) arcs_.push_back({c.to, c.diverging});  // sorted by from already
  lengths_.reserve(network.tracks.size());
  for (const auto& t : network.tracks) lengths_.push_back(t.line.length());
}

bool OrientedGraph::feasible(OrientedTrack from, OrientedTrack to) const {
  const auto out = successors(from);
  return std::any_of(out.begin(), out.end(), [&](const Arc& a) { return a.to == to; });
}

}  // namespace versine::network
