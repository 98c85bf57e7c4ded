// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <unordered_map>
#include <vector>

#include "adjustment.hpp"
#include "versine/core/error.hpp"
#include "versine/stationing/network_adjustment.hpp"

/// The unknowns and observations of a network, and their start values.
namespace versine::stationing {

/// A station hangs on its mark: the centre of the instrument is `height` above the point, along the plumb line.
struct NetworkStation {
  const ReducedStation* readings;
  std::size_t mark;
  double height;
  Eigen::Quaterniond q_ms = Eigen::Quaterniond::Identity();
  bool placed = false;
};

struct NetworkSighting {
  std::size_t station, point;
  const Target* target;
  bool used = true;
};

struct NetworkModel {
  std::vector<std::string> names;            ///< of the points
  std::vector<Eigen::Vector3d> positions;    ///< start, then solution
  std::vector<const ControlPoint*> control;  ///< nullptr: unknown coordinates
  std::vector<bool> held;                    ///< control points whose coordinates count as observations
  std::vector<NetworkStation> stations;
  std::vector<NetworkSighting> sightings;
};

/// s-frame, m.
Eigen::Vector3d local_vector(const Target& t);

/// Collects points and observations and finds start values for all.
Expected<NetworkModel> build_network(std::span<const ReducedStation> stations, const ControlNetwork& control,
                                     const NetworkOptions& options);

}  // namespace versine::stationing
