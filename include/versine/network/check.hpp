// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "versine/network/network.hpp"

namespace versine::network {

/// Something about a map that a person should look at.
struct MapFinding {
  std::string kind;  ///< "near miss", "isolated piece", "dead end", "unlabelled four-armed node", "no way through",
                     ///< "kink", "duplicated track"
  Eigen::Vector2d place;  ///< map m relative to Network::origin
  std::string track;      ///< one of the tracks concerned
  double value = 0.0;     ///< near miss: m; isolated piece, duplicated track: its length, m; kink: rad; else 0
};

struct MapCheck {
  std::vector<MapFinding> findings;
  std::size_t switches = 0;  ///< joints of three ends, one of which leads to both others
  std::size_t pieces = 0;    ///< connected pieces
  double length = 0.0;       ///< of all tracks, m
};

/// `kink`: the least angle between two segments of a track that counts as one, rad.
[[nodiscard]] MapCheck check(const Network& network, double kink = 0.17);

}  // namespace versine::network
