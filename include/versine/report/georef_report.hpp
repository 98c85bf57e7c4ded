// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "versine/report/facts.hpp"

/// The report of `versine georef`: journeys on a network.
namespace versine::report {

struct GeorefJourney {
  int recording = 1, journey = 1;
  std::vector<double> time;                   ///< s since the journey's start
  std::vector<double> distance;               ///< m on the most probable path, at each time
  std::vector<double> speed, sigma_speed;     ///< km/h; sigma empty when unknown
  std::vector<double> sigma;                  ///< along the track, m
  std::vector<std::vector<Point>> paths;      ///< map metres, the most probable first
  std::vector<std::vector<Point>> ambiguous;  ///< stretches of the first path
};

struct GeorefReport {
  Facts facts;
  std::string network, tracks;            ///< file; how many tracks
  std::vector<std::vector<Point>> lines;  ///< of the network, map metres
  std::vector<GeorefJourney> journeys;
  RawTable table;      ///< a row per journey: recording, journey, name, from_s, ..., as in the result
  RawTable failed;     ///< name, error
  RawTable ambiguous;  ///< least certain first
  RawTable switches;
};

[[nodiscard]] Document georef_document(const GeorefReport& report, const Texts& texts);

}  // namespace versine::report
