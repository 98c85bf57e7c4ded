// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "versine/app/geometry.hpp"
#include "versine/app/progress_file.hpp"
#include "versine/app/report.hpp"
#include "versine/io/read_recording.hpp"

namespace versine::app {

void describe(ConfigVisitor& v, GeometryJobConfig& c) {
  v.value("job", c.job, {.doc = "Kind of this job.", .required = true, .example = "\"geometry\""});
  v.value("title", c.title, {.doc = "Line and track, for reports."});
  v.table("trajectory", "Where the trolley's IMU was, and how it lay: of Versine or of other software.",
          [&](ConfigVisitor& t) { describe(t, c.trajectory); });
  v.tables<OdometerFileConfig>("odometer", "An odometer, for mileage = \"odometer\".", c.odometers,
                               [](ConfigVisitor& t, OdometerFileConfig& f) { describe(t, f); });
  v.table(
      "geometry", "Track geometry.", [&](ConfigVisitor& t) { describe(t, c.geometry); }, &c.geometry.present);
  v.table(
      "report", "A report beside the result (docs/report.md); without this table none is made.",
      [&](ConfigVisitor& t) { describe(t, c.report, true); }, &c.report.present);
  v.table("output", "Where to.", [&](ConfigVisitor& t) {
    t.value("folder", c.folder, {.doc = "Result folder; default: the job's name with .result, beside the job."});
  });
}

Expected<GeometryRun> run_geometry(const std::filesystem::path& job, std::span<const std::string> overrides,
                                   const std::filesystem::path& output, Progress& progress) {
  GeometryJobConfig config;
  if (auto done = read_config(
          job, [&](ConfigVisitor& v) { describe(v, config); }, overrides);
      !done) {
    return tl::unexpected(done.error());
  }
  if (auto done = check_report(config.report); !done) return tl::unexpected(done.error());
  if (!config.trajectory.given()) {
    return fail({.file = job.string(),
                 .field = "trajectory.file",
                 .found = "nothing",
                 .expected = "a trajectory",
                 .advice = "name trajectory.h5 of a survey's result, or a CSV of other software"});
  }
  auto folder = io::ResultFolder::create(result_target(job, output, config.folder));
  if (!folder) return tl::unexpected(folder.error());
  io::Run run = begin_run("geometry");
  if (auto done = note_file("trajectory", config.trajectory.file, run.inputs); !done)
    return tl::unexpected(done.error());
  auto trajectory = io::read_trajectory(config.trajectory.description);
  if (!trajectory) return tl::unexpected(trajectory.error());
  trajectory->series.origin = config.trajectory.file.written;
  std::vector<Series<sensors::OdometerSample>> odometers;
  for (const auto& o : config.odometers) {
    auto raw = io::read_odometer(o.description);
    if (!raw) return tl::unexpected(raw.error());
    if (auto done = note_file("odometer", o.file, run.inputs); !done) return tl::unexpected(done.error());
    odometers.push_back(std::move(raw->series));
  }
  ProgressFile visible(progress, *folder);
  auto result = compute_track_geometry(config.geometry, trajectory->series, nullptr, odometers, {}, visible);
  if (!result) return tl::unexpected(result.error());
  if (auto done = write_track_geometry(config.geometry, *result, *folder, visible); !done)
    return tl::unexpected(done.error());
  run.time_scale = trajectory->series.scale;
  run.inputs.insert(run.inputs.end(), result->files.begin(), result->files.end());
  run.settings_json = config_json([&](ConfigVisitor& v) { describe(v, config); });
  run.results_json = geometry_summary_json(*result);
  run.record = std::move(trajectory->record);
  run.record.append(result->geometry.record);
  if (auto done = io::write_run_json(folder->path("run.json"), run); !done) return tl::unexpected(done.error());
  if (auto done = write_job_report(config.report, folder->folder(), folder->target()); !done) {
    return tl::unexpected(done.error());
  }
  if (auto done = folder->commit(); !done) return tl::unexpected(done.error());
  GeometryRun out{folder->target(), nlohmann::ordered_json::parse(run.results_json).dump(2),
                  geometry_summary_text(*result)};
  if (result->quality && !result->quality->exceedances.empty()) {
    int worst = 0, levels = 0;
    for (const auto& e : result->quality->exceedances) worst = std::max(worst, e.severity);
    if (const auto limits = read_limits(config.geometry.limits.path); limits)
      levels = static_cast<int>(limits->levels.size());
    out.acceptable = worst + 1 < levels;
  }
  return out;
}

}  // namespace versine::app
