// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "versine/georef/options.hpp"
#include "versine/network/oriented_graph.hpp"
#include "versine/network/path.hpp"
#include "versine/network/spatial_index.hpp"

namespace versine::georef {

/// The map with what is derived from it once.
struct Map {
  network::Network network;
  network::OrientedGraph graph;
  network::SpatialIndex index;

  explicit Map(network::Network n) : network(std::move(n)), graph(network), index(network) {}
  Map(const Map&) = delete;  // the index refers to the network
  Map& operator=(const Map&) = delete;
};

/// A fix for the coarse search.
struct Knot {
  Time time;
  Eigen::Vector2d point;    ///< map m relative to Network::origin
  double sigma = 1.0;       ///< m
  double weight = 1.0;      ///< how many independent fixes it stands for, at most 1 with correlated errors
  double travelled = -1.0;  ///< m since the knot before, from speeds; negative: not known
};

struct Hypothesis {
  network::Path path;
  double cost = 0.0;    ///< minus coarse log-likelihood
  double prior = 0.0;   ///< log prior of the legs taken at facing switches
  double astray = 0.0;  ///< the part of `cost` from fixes too bad for the filter (sigma above largest_sigma)
};

/// Hypotheses for an uninterrupted run of knots [first, last].
struct Stretch {
  std::size_t first = 0, last = 0;
  std::vector<Hypothesis> hypotheses;  ///< best first, distinct
};

/// Where a journey may begin, as the one before it ended.
struct StartPlace {
  network::TrackIndex track = 0;
  double distance = 0.0;  ///< from the track's beginning, m
  double sigma = 1.0;     ///< m
  double probability = 0.0;
};

/// The k best paths through the oriented graph (list Viterbi over candidate tracks of each knot, routes between knots
/// by Dijkstra with a bounded number of labels a state): cost grows linearly with the knots and does not depend on
/// the number of paths that exist. Knots that no candidate explains are passed over; where the map offers no way on,
/// a new stretch begins. No stretch: nothing of the map is near, or constraints leave nothing. `start`: prior of the
/// first knot's track; empty: none.
[[nodiscard]] std::vector<Stretch> infer_paths(const Map& map, std::span<const Knot> knots,
                                               const InferenceOptions& options,
                                               std::span<const Constraint> constraints = {},
                                               std::span<const StartPlace> start = {});

}  // namespace versine::georef
