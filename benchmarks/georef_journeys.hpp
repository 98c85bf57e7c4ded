// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "georef_score.hpp"
#include "versine/geodesy/geodetic.hpp"
#include "versine/network/source.hpp"

/// Simulated journeys of an in-service vehicle, georeferenced.
namespace versine::benchmarks {

/// A set of journeys: where, and how good GNSS is.
struct Place {
  std::string name;
  network::NetworkSource source;
  std::optional<geodesy::Geodetic> centre;  ///< stops lie within `radius` of it; none: anywhere
  double radius = 0.0;                      ///< m
  int across = 0;                           ///< bridges cross the tracks: 0: they go north, 1: east
  std::vector<double> bridges;              ///< their axes, m east (north) of the middle of the stops' area; 50 m wide
};
struct Receiver {
  std::string name;
  double white, coloured, correlation_time;  ///< m, m, s: true errors of each axis
  double told_time;                          ///< s, in the job
  bool imu, turn_rate;
};

/// The made harbour railway: 89 tracks, 18 km, nine scissors, two ladders, a triangle.
[[nodiscard]] Place harbour();
/// The Utrecht station area of the Dutch network, in a folder of data.
[[nodiscard]] Expected<Place> utrecht(const std::string& data);

/// Recordings 1 to `count` on a place, each as every receiver records it, on many threads. One score a receiver.
[[nodiscard]] std::vector<Score> drive(const Place& place, std::span<const Receiver> receivers, std::uint64_t count,
                                       int threads, bool verbose);

}  // namespace versine::benchmarks
