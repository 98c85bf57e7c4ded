// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "versine/app/georef_online.hpp"
#include "versine/app/job_kinds.hpp"
#include "versine/app/recording_config.hpp"
#include "versine/app/report_config.hpp"
#include "versine/core/progress.hpp"
#include "versine/core/units.hpp"
#include "versine/georef/georeference.hpp"
#include "versine/georef/monitoring.hpp"
#include "versine/io/network_file.hpp"
#include "versine/network/build.hpp"

namespace versine::app {

extern const JobKind georef_job;  ///< `versine georef`

/// A recording in several files, or in one whose columns need names.
struct RecordingConfig {
  std::string name;  ///< in results; empty: the GNSS file as written
  GnssFileConfig gnss;
  ImuFileConfig imu;
  SpeedFileConfig speed;
  OdometerFileConfig odometer;
};

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
  std::string job = "georef", title;
  InputPath network;
  std::string layer, id_field, source_crs, crs;
  std::vector<std::string> osm_types{"rail", "light_rail"};
  double snap = 1.0, largest_turn = 30.0 * units::deg;
  std::vector<InputPath> recordings;
  std::vector<RecordingConfig> tables;  ///< [[recording]]
  georef::Options options;
  InputPath constraints_file;
  std::vector<georef::Constraint> constraints;
  std::vector<MonitoringConfig> monitoring;
  bool run_online = false;  ///< `--online`: replay the recordings through the online filter too
  georef::OnlineOptions online;
  double csv_interval = 1.0;  ///< s between rows of positions.csv and points of the GeoPackage
  ReportConfig report;
  bool hdf5 = true, gpkg = true;
};
void describe(ConfigVisitor& v, GeorefConfig& c);

/// What belongs to one recording of a batch, in a file of its own beside it.
struct GeorefCompanion {
  std::vector<georef::Constraint> constraints;
  std::vector<MonitoringConfig> monitoring;
};
[[nodiscard]] Expected<GeorefCompanion> read_companion(const std::filesystem::path& path);

/// Adds what the constraints file of a job says to its own constraints. Layout: docs/formats-georef.md.
[[nodiscard]] Expected<void> load_constraints(GeorefConfig& config);

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
/// A recording in several files.
[[nodiscard]] Expected<georef::Recording> load_recording(const RecordingConfig& config);

struct GeorefRun {
  std::filesystem::path folder;
  std::string summary_text, summary_json;
  std::vector<Error> faults;  ///< recordings, or parts of them, without a result
};
/// The job: map, recordings on `threads` threads (0: all cores), with `online` also replayed
/// through the online filter, results in a folder that appears whole or not at all.
/// A recording that fails is reported and the rest is processed; fails when all do.
[[nodiscard]] Expected<GeorefRun> run_georef(const std::filesystem::path& job, std::span<const std::string> overrides,
                                             const std::filesystem::path& output, int threads, bool online,
                                             Progress& progress);

/// monitoring_N.h5 in `folder` for each monitoring file of the job; reads them block by block.
[[nodiscard]] Expected<void> stamp_monitoring(const std::filesystem::path& folder, const georef::Map& map,
                                              const std::vector<GeorefOutcome>& outcomes,
                                              const std::vector<MonitoringConfig>& files, Progress& progress);

/// positions.csv, fixes.csv, paths.csv, switches.csv. Layout of these and the next: docs/formats-georef.md.
[[nodiscard]] Expected<void> write_georef_tables(const std::filesystem::path& folder, const georef::Map& map,
                                                 const std::vector<GeorefOutcome>& outcomes,
                                                 const georef::Options& options, double interval);
/// georef.json and network.geojson.
[[nodiscard]] Expected<void> write_georef_index(const std::filesystem::path& folder, const georef::Map& map,
                                                const std::vector<GeorefOutcome>& outcomes);

}  // namespace versine::app
