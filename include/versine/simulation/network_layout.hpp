// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "versine/network/source.hpp"

namespace versine::simulation {

/// A made railway: a double line (tracks "A..." and "B...", from west to east) with scissors crossovers, a station with
/// ladders of switches at both ends ("S1", "S2", ...), a siding that ends at a buffer stop ("D"), and a turning
/// triangle with a dead end ("T..."). Every switch is a joint of track ends; curves are polylines with a point every 5
/// m.
struct NetworkLayout {
  double length = 6000.0;  ///< of the double line, m; at least 3000 + 460 for each crossover beyond the first
  double spacing = 4.5;    ///< between parallel tracks, m
  int crossovers = 1;      ///< scissors, 460 m from one to the next
  int station_tracks = 4;  ///< beside the double line
  bool triangle = true;
  std::string crs = "EPSG:25832";
  double easting = 560000.0, northing = 5700000.0;  ///< of the western end of track A
};

/// The layout as a map file would tell it; `network::build` makes the network of it.
[[nodiscard]] network::NetworkSource make_network(const NetworkLayout& layout);

}  // namespace versine::simulation
