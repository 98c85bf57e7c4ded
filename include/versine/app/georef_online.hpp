// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "versine/georef/online.hpp"

namespace versine::app {

/// A recording replayed through the online filter, against its offline result.
struct OnlineReplay {
  std::string name;
  std::vector<georef::OnlinePosition> positions;
  std::vector<georef::OnlineDecision> decisions;
  std::size_t restarts = 0;
  // Decisions at facing switches: seconds and metres from entering the leg until it was decided.
  std::size_t legs = 0, revised = 0, wrong = 0;  ///< wrong: the offline path does not take it
  double median_seconds = 0, worst_seconds = 0, median_metres = 0, worst_metres = 0;
  // Against the offline positions at the same times, where the online sigma is below `sure` (not in a tunnel).
  static constexpr double sure = 5.0;  ///< m
  std::size_t compared = 0, unsure = 0;
  double same_track = 0;    ///< share of positions on the offline path's track
  double rms = 0, p95 = 0;  ///< distance on the map, m
  double coverage = 0;      ///< of all on the same track: share within 1.96 sigma of the offline place
  double seconds_cpu = 0;   ///< processor time of the whole replay
};

[[nodiscard]] OnlineReplay replay_online(const georef::Map& map, georef::Recording recording,
                                         const georef::RecordingResult& offline, const georef::Options& options,
                                         const georef::OnlineOptions& online);
/// online.csv and online_decisions.csv. Layout: docs/formats-georef.md.
[[nodiscard]] Expected<void> write_online_csv(const std::filesystem::path& folder, const georef::Map& map,
                                              const std::vector<OnlineReplay>& replays);
/// A line or two for a person.
[[nodiscard]] std::string online_text(const OnlineReplay& replay);

}  // namespace versine::app
