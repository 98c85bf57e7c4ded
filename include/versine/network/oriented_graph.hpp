// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "versine/network/network.hpp"

namespace versine::network {

/// The graph whose nodes are oriented tracks: a walk along it is a movement that a wheel can make without reversing.
class OrientedGraph {
 public:
  explicit OrientedGraph(const Network& network);

  struct Arc {
    OrientedTrack to;
    bool diverging = false;
  };
  [[nodiscard]] std::span<const Arc> successors(OrientedTrack from) const {
    const auto s = from.state();
    return {arcs_.data() + first_[s], arcs_.data() + first_[s + 1]};
  }
  [[nodiscard]] double length(OrientedTrack t) const { return lengths_[t.track]; }
  [[nodiscard]] std::size_t states() const { return first_.size() - 1; }
  [[nodiscard]] bool feasible(OrientedTrack from, OrientedTrack to) const;

 private:
  std::vector<std::uint32_t> first_;  // of each state's arcs
  std::vector<Arc> arcs_;
  std::vector<double> lengths_;  // of each track
};

}  // namespace versine::network
