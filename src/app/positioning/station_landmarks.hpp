// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>

#include "versine/app/stationing.hpp"

/// From computed stations to landmark updates, in order of time, with what neighbours share.
namespace versine::app {

/// Of each station beside the track: the trolley's stops that it saw, as stations of one target each.
using PrismStops = std::map<std::string, std::vector<stationing::Stationing>>;

/// Takes the sightings of the trolley's prism out of a station.
[[nodiscard]] std::vector<stationing::Stationing> take_prism(stationing::Stationing& station, const std::string& prism);

/// The instrument on the trolley: its own position, and with a mounting its attitude.
[[nodiscard]] std::vector<sensors::LandmarkSample> station_landmarks(const StationingOutcome& stations,
                                                                     const StationingProcessing& processing);

/// The instrument beside the track: the prism on the trolley.
[[nodiscard]] std::vector<sensors::LandmarkSample> prism_landmarks(const StationingOutcome& stations,
                                                                   const PrismStops& stops,
                                                                   const StationingProcessing& processing);

}  // namespace versine::app
