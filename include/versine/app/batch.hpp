// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "versine/app/georef.hpp"
#include "versine/batch/journey_entry.hpp"
#include "versine/batch/manifest.hpp"
#include "versine/batch/run.hpp"
#include "versine/core/progress.hpp"

/// Georeferencing as the stage of a batch. docs/batch.md.
namespace versine::app {

/// Version and stage, part of every unit's name.
[[nodiscard]] std::string batch_engine();

/// A recording's name and `.toml`: [[constraint]] and [[monitoring]] tables for it alone.
[[nodiscard]] std::filesystem::path companion_of(const std::filesystem::path& recording);
/// Recordings under a folder (by the endings of the formats that `versine georef` reads), or named in a text file, one
/// a line; sorted by path, with their digests. A recording's companion (its name and `.toml`) and the monitoring files
/// that this names follow it in its list.
[[nodiscard]] batch::Outcome<std::vector<std::vector<batch::Input>>> batch_inputs(
    const std::filesystem::path& folder_or_list, Progress& progress);
/// The job as a manifest keeps it; its constraints are for the whole fleet. Fails (64) when it cannot be read, (75)
/// when its map cannot.
[[nodiscard]] batch::Outcome<batch::Job> batch_job(const std::filesystem::path& job);

/// Does units: reads a recording, puts it on the map, leaves the objects `summary`, `positions`, and `monitoring_N` for
/// each monitoring file of its companion. One a process.
class GeorefStage {
 public:
  /// Fails (78) when the manifest's engine or configuration is not this one's.
  [[nodiscard]] static batch::Outcome<GeorefStage> prepare(const batch::Manifest& manifest);
  [[nodiscard]] batch::Outcome<batch::Made> operator()(const batch::Unit& unit) const;

 private:
  /// Puts the companion's monitoring files on the track; those that cannot be are told in the summary.
  [[nodiscard]] batch::Outcome<void> stamp(const GeorefCompanion& companion, const std::vector<GeorefOutcome>& outcomes,
                                           batch::Summary& summary, batch::Made& made) const;
  GeorefConfig config_;
  std::shared_ptr<const georef::Map> map_;
};

/// What a catalogue keeps of the journeys of a recording.
[[nodiscard]] std::vector<batch::JourneyEntry> journey_entries(const georef::Map& map,
                                                               const georef::RecordingResult& result);
/// positions.csv of several recordings, every `interval` s of the most probable path.
[[nodiscard]] std::string positions_table(const georef::Map& map,
                                          const std::vector<const georef::RecordingResult*>& results, double interval);

}  // namespace versine::app
