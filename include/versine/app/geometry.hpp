// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "versine/app/geometry_config.hpp"
#include "versine/app/geometry_coordinates.hpp"
#include "versine/app/job_run.hpp"
#include "versine/app/report_config.hpp"
#include "versine/filter/error_chain.hpp"
#include "versine/io/fastenings_csv.hpp"
#include "versine/io/result_folder.hpp"
#include "versine/io/run_json.hpp"
#include "versine/track/calibration.hpp"
#include "versine/track/quality.hpp"
#include "versine/track/repeatability.hpp"

/// From a trajectory to track geometry, its quality, adjustment and files: the last stages of `versine survey`, all of
/// `versine geometry`.
namespace versine::app {

struct GeometryResult {
  track::Geometry geometry;
  std::optional<track::Geometry> at_sleepers;
  std::optional<track::Quality> quality;
  std::optional<track::Adjustment> slew, lift;
  std::optional<design::Alignment> design;  ///< what deviations refer to, unless it is `axis`
  std::optional<design::OptimalAxis> axis;
  std::optional<io::FasteningPlans> fastenings;
  std::optional<CoordinateTie> tie;  ///< to the project's grid and heights
  std::vector<io::RunInput> files;   ///< design, gauge, sleeper, limits
};

/// `crs` is that of the job's output; empty: the design's or UTM.
[[nodiscard]] Expected<GeometryResult> compute_track_geometry(
    const GeometryConfig& config, const geodesy::Trajectory& trajectory, const filter::ErrorChain* chain,
    const std::vector<Series<sensors::OdometerSample>>& odometers, const std::string& crs, Progress& progress);

/// Writes the files of the result into the folder (not run.json).
[[nodiscard]] Expected<void> write_track_geometry(const GeometryConfig& config, const GeometryResult& result,
                                                  const io::ResultFolder& folder, Progress& progress);

/// Summary for run.json and `--json`: an object, as text; and for a person.
[[nodiscard]] std::string geometry_summary_json(const GeometryResult& result);
[[nodiscard]] std::string geometry_summary_text(const GeometryResult& result);

/// Files of the design, gauge and sleeper of a configuration, read.
struct GeometryFiles {
  std::optional<design::Alignment> design;
  Series<sensors::GaugeSample> gauge;
  Series<sensors::RangeSample> range;
  RunRecord record;
  std::vector<io::RunInput> files;
};
[[nodiscard]] Expected<GeometryFiles> read_geometry_files(const GeometryConfig& config);

/// `versine geometry`.
struct GeometryJobConfig {
  std::string job = "geometry";
  std::string title;
  TrajectoryFileConfig trajectory;
  std::vector<OdometerFileConfig> odometers;
  GeometryConfig geometry;
  ReportConfig report;
  std::string folder;
};
void describe(ConfigVisitor& v, GeometryJobConfig& c);

struct GeometryRun {
  std::filesystem::path folder;
  std::string summary_json, summary_text;
  bool acceptable = true;  ///< no exceedance of the severest level
};
[[nodiscard]] Expected<GeometryRun> run_geometry(const std::filesystem::path& job,
                                                 std::span<const std::string> overrides,
                                                 const std::filesystem::path& output, Progress& progress);

/// `versine calibrate`: several passes of one trolley.
struct CalibrateConfig {
  std::string job = "calibrate";
  std::string title;
  struct Pass {
    std::string name;
    TrajectoryFileConfig trajectory;
    GaugeFileConfig gauge;
  };
  std::vector<Pass> passes;
  GeometryConfig geometry;
  double settle = 10.0;  ///< m
  std::string folder;
};
void describe(ConfigVisitor& v, CalibrateConfig& c);

struct Calibration {
  std::optional<track::MountingCalibration> mounting;
  std::string no_mounting;  ///< why there is none
  struct Pair {
    std::string reference, run;
    double direction = 1.0;  ///< -1: turned round against the reference
    std::vector<track::MileageShift> shifts;
    std::vector<track::Repeatability> columns;
  };
  std::vector<Pair> pairs;
};
/// Are there passes to compare?
[[nodiscard]] Expected<void> check_passes(const CalibrateConfig& config);
[[nodiscard]] Expected<Calibration> compute_calibration(const CalibrateConfig& config, Progress& progress);
[[nodiscard]] Expected<GeometryRun> run_calibrate(const std::filesystem::path& job,
                                                  std::span<const std::string> overrides,
                                                  const std::filesystem::path& output, Progress& progress);

}  // namespace versine::app
