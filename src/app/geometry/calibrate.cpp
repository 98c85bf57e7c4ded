// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "versine/app/geometry.hpp"
#include "versine/core/units.hpp"
#include "versine/io/read_recording.hpp"
#include "versine/sensors/series_check.hpp"

namespace versine::app {
namespace {

using json = nlohmann::ordered_json;

json euler_json(const geodesy::Euler& e) {
  return {{"roll_deg", e.roll / units::deg}, {"pitch_deg", e.pitch / units::deg}, {"yaw_deg", e.yaw / units::deg}};
}

json to_json(const Calibration& c) {
  json out = json::object();
  if (c.mounting) {
    out["mounting"] = {{"new", euler_json(c.mounting->mounting)},
                       {"correction", euler_json(c.mounting->correction)},
                       {"sigma", euler_json(c.mounting->sigma)},
                       {"length_m", c.mounting->length}};
  } else {
    out["no_mounting"] = c.no_mounting;
  }
  for (const auto& p : c.pairs) {
    json pair{{"reference", p.reference}, {"run", p.run}, {"turned_round", p.direction < 0.0}};
    for (const auto& s : p.shifts)
      pair["shifts"].push_back({{"mileage_m", s.mileage}, {"shift_m", s.shift}, {"correlation", s.correlation}});
    for (const auto& r : p.columns) {
      pair["columns"].push_back(
          {{"column", r.column}, {"points", r.count}, {"mean", r.mean}, {"rms", r.rms}, {"p95", r.p95}});
    }
    out["pairs"].push_back(std::move(pair));
  }
  return out;
}

std::string to_text(const Calibration& c) {
  std::string text;
  if (c.mounting) {
    const auto row = [&](const char* name, double value, double change, double sigma) {
      text += fmt::format("  {:<8} {:10.5f} deg   change {:9.5f}   sigma {:.5f}\n", name, value / units::deg,
                          change / units::deg, sigma / units::deg);
    };
    const auto& m = *c.mounting;
    text += fmt::format("Mounting from {:.1f} m passed in both orientations:\n", m.length);
    row("roll", m.mounting.roll, m.correction.roll, m.sigma.roll);
    row("pitch", m.mounting.pitch, m.correction.pitch, m.sigma.pitch);
    row("yaw", m.mounting.yaw, m.correction.yaw, m.sigma.yaw);
  } else {
    text += "No mounting: " + c.no_mounting + "\n";
  }
  for (const auto& p : c.pairs) {
    text += fmt::format("{} against {}{}: {:>8} {:>8} {:>8}  (mm)\n", p.run, p.reference,
                        p.direction < 0.0 ? ", turned round" : "", "mean", "RMS", "95 %");
    for (const auto& r : p.columns) {
      const bool shown = r.column == "gauge" || r.column == "cross_level" || r.column.starts_with("check_30m") ||
                         r.column.ends_with("_d1");
      if (shown && !r.column.ends_with("_worst")) {
        text += fmt::format("  {:<36} {:8.3f} {:8.3f} {:8.3f}\n", r.column, 1e3 * r.mean, 1e3 * r.rms, 1e3 * r.p95);
      }
    }
  }
  return text;
}

}  // namespace

void describe(ConfigVisitor& v, CalibrateConfig& c) {
  v.value("job", c.job, {.doc = "Kind of this job.", .required = true, .example = "\"calibrate\""});
  v.value("title", c.title, {.doc = "For reports."});
  v.tables<CalibrateConfig::Pass>(
      "pass", "A pass of the trolley over the common stretch.", c.passes,
      [](ConfigVisitor& t, CalibrateConfig::Pass& p) {
        t.value("name", p.name, {.doc = "For tables.", .required = true});
        t.table("trajectory", "Its trajectory.", [&](ConfigVisitor& u) { describe(u, p.trajectory); });
        t.table("gauge", "Its gauge sensor.", [&](ConfigVisitor& u) { describe(u, p.gauge); });
      });
  v.value("settle_m", c.settle, {.doc = "Length over which errors are alike.", .unit = "m", .positive = true});
  v.table(
      "geometry", "Design, trolley and parameters, as in a geometry job.",
      [&](ConfigVisitor& t) { describe(t, c.geometry); }, &c.geometry.present);
  v.table("output", "Where to.", [&](ConfigVisitor& t) {
    t.value("folder", c.folder, {.doc = "Result folder; default: the job's name with .result, beside the job."});
  });
}

Expected<void> check_passes(const CalibrateConfig& config) {
  if (config.passes.size() >= 2) return {};
  return fail({.field = "pass",
               .found = fmt::format("{} passes", config.passes.size()),
               .expected = "two or more",
               .advice = "add [[pass]] for each run over the common stretch"});
}

Expected<Calibration> compute_calibration(const CalibrateConfig& config, Progress& progress) {
  if (auto good = check_passes(config); !good) return tl::unexpected(good.error());
  auto files = read_geometry_files(config.geometry);
  if (!files) return tl::unexpected(files.error());
  std::vector<track::AttitudeLine> lines;
  std::vector<track::Geometry> runs;
  for (const auto& pass : config.passes) {
    auto trajectory = io::read_trajectory(pass.trajectory.description);
    if (!trajectory) return tl::unexpected(trajectory.error());
    track::GeometryInput input;
    input.trajectory = &trajectory->series;
    input.trolley = config.geometry.trolley;
    if (files->design) input.design = &*files->design;
    if (!config.geometry.crs.empty()) {
      auto projection = geodesy::Projection::create(config.geometry.crs);
      if (!projection) return tl::unexpected(projection.error());
      input.projection = std::move(*projection);
    }
    if (pass.gauge.given()) {
      auto raw = io::read_gauge(pass.gauge.description);
      if (!raw) return tl::unexpected(raw.error());
      auto checked = sensors::check_gauge(std::move(raw->series), {.file = pass.gauge.file.path.string()});
      if (!checked) return tl::unexpected(checked.error());
      input.gauge = std::move(checked->series);
    }
    auto line = track::attitude_line(input, config.geometry.options, progress);
    if (!line) return tl::unexpected(line.error());
    lines.push_back(std::move(*line));
    auto geometry = track::compute_geometry(input, config.geometry.options, progress);
    if (!geometry) return tl::unexpected(geometry.error());
    runs.push_back(std::move(*geometry));
  }
  Calibration out;
  auto mounting = track::calibrate_mounting(lines, config.geometry.trolley.mounting, config.settle);
  if (mounting)
    out.mounting = *mounting;
  else
    out.no_mounting = mounting.error().found;
  for (std::size_t i = 1; i < runs.size(); ++i) {
    Calibration::Pair pair{config.passes[0].name, config.passes[i].name, lines[0].direction * lines[i].direction};
    pair.shifts = track::find_shifts(runs[0], runs[i]);
    pair.columns = track::compare(runs[0], track::aligned_to(runs[0], runs[i], pair.shifts));
    out.pairs.push_back(std::move(pair));
  }
  return out;
}

Expected<GeometryRun> run_calibrate(const std::filesystem::path& job, std::span<const std::string> overrides,
                                    const std::filesystem::path& output, Progress& progress) {
  CalibrateConfig config;
  if (auto done = read_config(
          job, [&](ConfigVisitor& v) { describe(v, config); }, overrides);
      !done) {
    return tl::unexpected(done.error());
  }
  auto folder = io::ResultFolder::create(result_target(job, output, config.folder));
  if (!folder) return tl::unexpected(folder.error());
  io::Run run = begin_run("calibrate");
  for (const auto& pass : config.passes) {
    if (auto done = note_file("trajectory of " + pass.name, pass.trajectory.file, run.inputs); !done) {
      return tl::unexpected(done.error());
    }
  }
  const auto calibration = compute_calibration(config, progress);
  if (!calibration) return tl::unexpected(calibration.error());
  run.settings_json = config_json([&](ConfigVisitor& v) { describe(v, config); });
  run.results_json = to_json(*calibration).dump();
  if (auto done = io::write_run_json(folder->path("run.json"), run); !done) return tl::unexpected(done.error());
  if (auto done = folder->commit(); !done) return tl::unexpected(done.error());
  return GeometryRun{folder->target(), to_json(*calibration).dump(2), to_text(*calibration)};
}

}  // namespace versine::app
