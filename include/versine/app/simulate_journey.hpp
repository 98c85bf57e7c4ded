// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "versine/app/config.hpp"
#include "versine/network/network.hpp"
#include "versine/network/source.hpp"
#include "versine/simulation/journey.hpp"
#include "versine/simulation/network_layout.hpp"

namespace versine::app {

/// The part of a scenario that drives on a railway network instead of an alignment.
struct JourneyConfig {
  bool present = false;  ///< the scenario has a table [network]
  InputPath file;
  std::string crs;
  bool made = false;  ///< [network.made]
  simulation::NetworkLayout layout;
  double height = 100.0, smoothing = 10.0;
  std::vector<simulation::JourneyStop> stops;
};
void describe(ConfigVisitor& v, JourneyConfig& c);

/// The network to drive on; `source` is kept when it was made, to be written beside the recording.
struct JourneyNetwork {
  network::Network network;
  std::optional<network::NetworkSource> source;
};
[[nodiscard]] Expected<JourneyNetwork> load_network(const JourneyConfig& c);

/// A job for `versine georef` beside the recording.
[[nodiscard]] std::string georef_job_for(const JourneyConfig& c);

}  // namespace versine::app
