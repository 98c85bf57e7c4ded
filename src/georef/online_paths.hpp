// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "versine/georef/path_inference.hpp"

namespace versine::georef {

/// A way on from the end of a path.
struct WayOn {
  network::Path tracks;
  double prior = 0.0;  ///< log prior of its legs
};

/// All ways of at least `metres` from the end of `track` (or to a dead end), at most `most`, the most probable first.
/// Empty: no way on.
[[nodiscard]] std::vector<WayOn> ways_on(const Map& map, network::OrientedTrack track, double metres, double diverging,
                                         std::size_t most);
/// After a gap: the shortest ways (two a track) of at most `metres` that lead onto a track within `radius` of a place.
[[nodiscard]] std::vector<WayOn> ways_to(const Map& map, network::OrientedTrack track, double metres,
                                         const Eigen::Vector2d& place, double radius, double diverging,
                                         std::size_t most);

}  // namespace versine::georef
