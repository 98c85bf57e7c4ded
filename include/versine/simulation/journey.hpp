// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/network/network.hpp"
#include "versine/network/path.hpp"
#include "versine/simulation/scenario.hpp"

namespace versine::simulation {

class World;

/// A place on a network where the vehicle stands, and how it got there.
struct JourneyStop {
  std::string track;          ///< id of the network's track
  double distance = 0.0;      ///< of the vehicle's middle from the track's own beginning, m
  double speed = 10.0;        ///< on the way here, m/s
  double acceleration = 0.5;  ///< m/s^2
  double stand = 30.0;        ///< standing here, s
};

/// Journeys of a vehicle on a railway network. It takes the shortest way that wheels can go from stop to stop, and
/// reverses at a stop where that is shorter. It faces in the direction of the first movement.
struct JourneyScenario {
  std::string name;
  std::vector<JourneyStop> stops;  ///< the first is where it starts
  Vehicle vehicle;
  double height = 100.0;  ///< ellipsoidal, m; networks have none
  double smoothing =
      10.0;  ///< spacing of the curve's control points, m: a map's corners are rounded over three of them
  Equipment equipment;
  Time start{1'400'000'000'000'000'000};
  TimeScale time_scale = TimeScale::gps;
  double truth_rate = 10.0;  ///< 1/s
};

/// A movement without reversal.
struct Movement {
  network::Path path;    ///< in the direction of movement
  double from = 0.0;     ///< on the path, m
  double to = 0.0;       ///< m
  std::size_t stop = 0;  ///< index of the stop it leads to
};
/// The shortest way from a place on a track to another, in either direction from the start. Fails when there is none.
[[nodiscard]] Expected<Movement> find_way(const network::Network& network, const JourneyStop& from,
                                          const JourneyStop& to);

/// What all runs share; `observe` and `simulate_runs` work on it as on an alignment. Distances of the truth are along
/// the journey; its `track` and `track_distance` are the network's. Fails when a stop is not on the network, a way does
/// not exist, or the vehicle reverses while it stands on a switch.
[[nodiscard]] Expected<std::shared_ptr<const World>> prepare_journey(const network::Network& network,
                                                                     const JourneyScenario& scenario);

}  // namespace versine::simulation
