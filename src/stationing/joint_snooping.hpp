// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <span>
#include <vector>

#include "versine/stationing/free_station.hpp"

/// Blunders and moved points as all stations of a survey together see them. What one station cannot tell (two targets
/// against two, a wrong sighting that the control point's own error hides), its neighbours tell.
namespace versine::stationing {

/// A station that was computed by itself.
struct SolvedStation {
  const ReducedStation* readings;
  StationResult* result;
  std::optional<Plumb> plumb = {};  ///< up to one rotation that all stations share
};

struct JointVerdict {
  std::vector<std::set<std::size_t>> left_out;  ///< of each station: indices of the targets that contradict the rest
  std::vector<bool> changed;                    ///< of each station: these are not the ones that it left out itself
  std::vector<MovedPoint> moved;
  std::vector<std::optional<Plumb>> plumb;  ///< of each station, where it agrees with the rest: with the rotation found
};

/// Least squares of neighbouring stations and their control points together, linear about the stations' own solutions,
/// with data snooping of sightings, coordinates and plumb lines: the worst first, what fits in the end comes back. A
/// control point that one station alone sees is never called moved. `moved`: points that are known to have moved.
[[nodiscard]] JointVerdict snoop_jointly(std::span<const SolvedStation> stations, const ControlNetwork& network,
                                         const std::vector<MovedPoint>& moved, const Instrument& instrument,
                                         const FreeStationOptions& options);

}  // namespace versine::stationing
