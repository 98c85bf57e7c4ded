// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "versine/app/config.hpp"
#include "versine/app/georef_online.hpp"
#include "versine/core/progress.hpp"
#include "versine/georef/georeference.hpp"
#include "versine/georef/monitoring.hpp"
#include "versine/io/network_file.hpp"
#include "versine/network/build.hpp"

namespace versine::app {

/// `[[monitoring]]`: channels to be put on the track.
struct MonitoringConfig {
  InputPath file;
  std::vector<std::string> channels;
  std::string times;
  std::optional<double> rate_hz;
  double start = 0.0, offset = 0.0, scale = 1.0;
  int recording = 1;  ///< whose journeys the vehicle made, counted from 1
  georef::MonitoringOptions options;
};

struct GeorefConfig {
  InputPath network;
  std::string layer, id_field, source_crs, crs;
  std::vector<std::string> osm_types{"rail", "light_rail"};
  double snap = 1.0, largest_turn = 0.5236;
  std::vector<InputPath> recordings;
  georef::Options options;
  std::vector<georef::Constraint> constraints;
  std::vector<MonitoringConfig> monitoring;
  bool run_online = false;  ///< `--online`: replay the recordings through the online filter too
  georef::OnlineOptions online;
  double csv_interval = 1.0;  ///< s between rows of positions.csv and points of the GeoPackage
};
void describe(ConfigVisitor& v, GeorefConfig& c);

/// One recording of a job, or why there is no result for it.
struct GeorefOutcome {
  std::string name;
  Expected<georef::RecordingResult> result;
};

/// Loads the map of a job.
[[nodiscard]] Expected<std::unique_ptr<georef::Map>> load_map(const GeorefConfig& config);
/// The recordings in a file, by its layout: HDF5 (OnboardEU), the measuring train's CSV, else any GNSS format of
/// io/read_recording.hpp. Parts of the file that cannot be read go to `faults`.
[[nodiscard]] Expected<std::vector<georef::Recording>> load_recordings(const std::filesystem::path& path,
                                                                       std::vector<Error>& faults);

struct GeorefSummary {
  std::vector<GeorefOutcome> outcomes;
  std::vector<OnlineReplay> online;  ///< with --online
  std::vector<Error> faults;
  double seconds_map = 0.0, seconds_solve = 0.0, seconds_write = 0.0;
};
/// The job: map, recordings, results in `folder` (positions.csv, paths.csv, georef.h5, result.gpkg, run.json), which
/// appears whole or not at all. A recording that fails is reported and the rest is processed; fails when all do.
[[nodiscard]] Expected<GeorefSummary> run_georef(const GeorefConfig& config, const std::filesystem::path& folder,
                                                 Progress& progress);

/// monitoring_N.h5 in `folder` for each monitoring file of the job; reads them block by block.
[[nodiscard]] Expected<void> stamp_monitoring(const std::filesystem::path& folder, const georef::Map& map,
                                              const std::vector<GeorefOutcome>& outcomes,
                                              const std::vector<MonitoringConfig>& files, Progress& progress);

/// positions.csv, paths.csv, switches.csv, residuals.csv. Layout: docs/formats-georef.md.
[[nodiscard]] Expected<void> write_georef_csv(const std::filesystem::path& folder, const georef::Map& map,
                                              const std::vector<GeorefOutcome>& outcomes, double interval);

}  // namespace versine::app
