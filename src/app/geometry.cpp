// SPDX-License-Identifier: Apache-2.0
#include "versine/app/geometry.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "versine/app/progress_file.hpp"
#include "versine/app/report.hpp"
#include "versine/app/version.hpp"
#include "versine/core/units.hpp"
#include "versine/io/alignment_csv.hpp"
#include "versine/io/alignment_file.hpp"
#include "versine/io/geometry_csv.hpp"
#include "versine/io/geometry_gis.hpp"
#include "versine/io/geometry_xlsx.hpp"
#include "versine/io/landxml.hpp"
#include "versine/io/read_recording.hpp"
#include "versine/sensors/series_check.hpp"

namespace versine::app {
namespace {

using json = nlohmann::ordered_json;

Expected<void> note_file(const char* role, const InputPath& path, std::vector<io::RunInput>& files) {
  auto file = io::describe_input(role, path.written, path.path);
  if (!file) return tl::unexpected(file.error());
  files.push_back(std::move(*file));
  return {};
}

/// Samples of the measured axis for the optimal axis.
std::vector<design::TrackSample> axis_samples(const track::Geometry& g) {
  std::vector<design::TrackSample> out;
  const auto &e = g.at("easting_axis").value, &n = g.at("northing_axis").value, &h = g.at("height_axis").value;
  const auto& c = g.at("cross_level").value;
  const auto reach = static_cast<std::size_t>(std::max(1.0, std::round(1.0 / g.step)));
  for (std::size_t i = reach; i + reach < g.size(); i += reach) {
    const double de = e[i + reach] - e[i - reach], dn = n[i + reach] - n[i - reach];
    if (std::isfinite(de) && std::isfinite(h[i]) && std::isfinite(c[i])) {
      out.push_back({g.mileage[i], e[i], n[i], std::atan2(de, dn), h[i], c[i]});
    }
  }
  return out;
}

Expected<void> adjust(const GeometryConfig& config, GeometryResult& r) {
  const auto plan = [&](const char* column, const track::AdjustmentOptions& options,
                        std::optional<track::Adjustment>& out) -> Expected<void> {
    const track::Column* c = r.geometry.find(column);
    if (c == nullptr) return {};
    auto a = track::plan_adjustment(r.geometry.mileage, c->value, r.geometry.step, options);
    if (!a) return tl::unexpected(a.error());
    out = std::move(*a);
    return {};
  };
  if (auto done = plan("deviation_lateral_axis", config.slew, r.slew); !done) return done;
  return plan("deviation_vertical_axis", config.lift, r.lift);
}

}  // namespace

Expected<GeometryFiles> read_geometry_files(const GeometryConfig& c) {
  GeometryFiles out;
  if (!c.design.empty()) {
    for (const auto& [role, path] :
         {std::pair{"design", &c.design}, {"gradients", &c.gradients}, {"stationing", &c.stationing}}) {
      if (path->empty()) continue;
      if (auto done = note_file(role, *path, out.files); !done) return tl::unexpected(done.error());
    }
    design::Audit audit;
    auto a = io::read_alignment({c.design.path, c.gradients.path, c.stationing.path}, c.design_name, {}, &audit);
    if (!a) return tl::unexpected(a.error());
    out.design = std::move(*a);
    if (out.design->crs.empty()) out.design->crs = c.crs;
  }
  if (c.gauge.given()) {
    if (auto done = note_file("gauge", c.gauge.file, out.files); !done) return tl::unexpected(done.error());
    auto raw = io::read_gauge(c.gauge.description);
    if (!raw) return tl::unexpected(raw.error());
    auto checked = sensors::check_gauge(std::move(raw->series), {.file = c.gauge.file.path.string()});
    if (!checked) return tl::unexpected(checked.error());
    out.gauge = std::move(checked->series);
    out.record.append(std::move(raw->record));
    out.record.append(std::move(checked->record));
  }
  if (c.sleeper.given()) {
    if (auto done = note_file("sleeper", c.sleeper.file, out.files); !done) return tl::unexpected(done.error());
    auto raw = io::read_range(c.sleeper.description);
    if (!raw) return tl::unexpected(raw.error());
    auto checked = sensors::check_range(std::move(raw->series), {.file = c.sleeper.file.path.string()});
    if (!checked) return tl::unexpected(checked.error());
    out.range = std::move(checked->series);
    out.record.append(std::move(raw->record));
    out.record.append(std::move(checked->record));
  }
  return out;
}

Expected<GeometryResult> compute_track_geometry(const GeometryConfig& config, const geodesy::Trajectory& trajectory,
                                                const filter::ErrorChain* chain,
                                                const std::vector<Series<sensors::OdometerSample>>& odometers,
                                                const std::string& crs, Progress& progress) {
  auto files = read_geometry_files(config);
  if (!files) return tl::unexpected(files.error());
  GeometryResult out;
  out.files = std::move(files->files);
  track::GeometryInput input;
  input.trajectory = &trajectory;
  input.chain = chain;
  input.gauge = std::move(files->gauge);
  input.range = std::move(files->range);
  input.odometers = odometers;
  for (const auto& m : config.marks) input.marks.push_back({Time::from_seconds(m.time_s), m.mileage});
  if (files->design) input.design = &*files->design;
  input.height_offset = config.height_offset;
  input.height_datum = config.height_datum;
  input.trolley = config.trolley;
  const std::string map =
      !config.crs.empty() ? config.crs : (files->design && !files->design->crs.empty() ? files->design->crs : crs);
  if (!map.empty()) {
    auto projection = geodesy::Projection::create(map);
    if (!projection) return tl::unexpected(projection.error());
    input.projection = std::move(*projection);
  }
  auto geometry = track::compute_geometry(input, config.options, progress);
  if (!geometry) return tl::unexpected(geometry.error());
  if (!files->design && config.fit_axis) {
    auto axis = design::optimal_axis(axis_samples(*geometry), config.axis);
    if (!axis) return tl::unexpected(axis.error());
    axis->alignment.crs = geometry->crs;
    // The axis counts from its own start; its mileage continues that of the run.
    axis->alignment.chainage = design::Chainage::offset(geometry->mileage.front() + std::max(1.0, geometry->step));
    auto again = config.options;
    again.height_reference = track::HeightReference::axis;
    input.design = &axis->alignment;
    input.projection = geodesy::Projection::create(geometry->crs).value();
    geometry = track::compute_geometry(input, again, progress);
    if (!geometry) return tl::unexpected(geometry.error());
    out.axis = std::move(*axis);
  }
  out.geometry = std::move(*geometry);
  out.geometry.record.append(std::move(files->record));
  if (!out.geometry.sleepers.empty()) {
    std::vector<double> at;
    for (const auto& s : out.geometry.sleepers) at.push_back(s.mileage);
    out.at_sleepers = track::sampled_at(out.geometry, at);
  }
  if (!config.limits.empty()) {
    if (auto done = note_file("limits", config.limits, out.files); !done) return tl::unexpected(done.error());
    const auto limits = read_limits(config.limits.path);
    if (!limits) return tl::unexpected(limits.error());
    auto quality = track::assess(out.geometry, *limits, config.speed);
    if (!quality) return tl::unexpected(quality.error());
    out.quality = std::move(*quality);
  }
  out.design = std::move(files->design);
  if (config.adjust) {
    if (auto done = adjust(config, out); !done) return tl::unexpected(done.error());
  }
  return out;
}

Expected<void> write_track_geometry(const GeometryConfig& c, const GeometryResult& r, const io::ResultFolder& folder,
                                    Progress& progress) {
  const track::Geometry& g = r.geometry;
  const track::Quality* quality = r.quality ? &*r.quality : nullptr;
  std::vector<std::function<Expected<void>()>> writers;
  if (c.csv) {
    writers.emplace_back([&] { return io::write_geometry_csv(folder.path("geometry.csv"), g); });
    writers.emplace_back([&] { return io::write_geometry_columns_csv(folder.path("geometry_columns.csv"), g); });
    if (const design::Alignment* a = r.axis ? &r.axis->alignment : r.design ? &*r.design : nullptr) {
      writers.emplace_back([&folder, a] { return io::write_alignment_csv(folder.path("design_elements.csv"), *a); });
    }
    if (r.at_sleepers) {
      writers.emplace_back([&] { return io::write_geometry_csv(folder.path("sleepers.csv"), *r.at_sleepers); });
    }
    if (quality != nullptr) {
      writers.emplace_back([&] { return io::write_exceedances_csv(folder.path("exceedances.csv"), g, *quality); });
      writers.emplace_back([&] { return io::write_sections_csv(folder.path("sections.csv"), g, *quality); });
    }
  }
  if (c.gpkg) {
    writers.emplace_back(
        [&] { return io::write_geometry_gpkg(folder.path("result.gpkg"), g, quality, {c.gis_interval}); });
  }
  if (c.xlsx) {
    writers.emplace_back([&] {
      return io::write_geometry_xlsx(folder.path("geometry.xlsx"), g, quality,
                                     r.at_sleepers ? &*r.at_sleepers : nullptr, c.xlsx_interval);
    });
  }
  if (c.dxf) {
    writers.emplace_back(
        [&] { return io::write_geometry_dxf(folder.path("geometry.dxf"), g, quality, {c.gis_interval}); });
  }
  if (r.slew || r.lift) {
    writers.emplace_back([&] {
      return io::write_adjustment_csv(folder.path("adjustment.csv"), g, r.slew ? &*r.slew : nullptr,
                                      r.lift ? &*r.lift : nullptr, c.table);
    });
  }
  if (r.axis) writers.emplace_back([&] { return io::write_landxml(folder.path("axis.xml"), {&r.axis->alignment, 1}); });
  for (std::size_t i = 0; i < writers.size(); ++i) {
    progress.report("writing geometry", double(i) / double(writers.size()));
    if (progress.cancelled()) return fail({.found = "cancelled"});
    if (auto done = writers[i](); !done) return done;
  }
  return {};
}

std::string geometry_summary_json(const GeometryResult& r) {
  const track::Geometry& g = r.geometry;
  json out{{"points", g.size()},
           {"step_m", g.step},
           {"from_m", g.posted_at(g.mileage.front())},
           {"to_m", g.posted_at(g.mileage.back())},
           {"crs", g.crs},
           {"height_datum", g.height_datum},
           {"sleepers", g.sleepers.size()}};
  for (const auto& [what, how] : g.conventions) out["conventions"][what] = how;
  for (const auto& p : g.posted) {
    out["posted"].push_back({{"start_m", p.start}, {"posted_m", p.posted_start}, {"increasing", p.increasing}});
  }
  if (r.quality) {
    json levels = json::object();
    for (const auto& e : r.quality->exceedances) levels[e.level] = levels.value(e.level, 0) + 1;
    out["quality"] = {
        {"limits", r.quality->profile}, {"source", r.quality->source}, {"speed_kmh", r.quality->speed / units::kmh},
        {"levels", r.quality->levels},  {"exceedances", levels},       {"unchecked", r.quality->unchecked}};
    if (r.quality->tqi_limit > 0.0) out["quality"]["tqi_limit_mm"] = r.quality->tqi_limit / units::mm;
    for (const track::Limit& limit : r.quality->applied) {
      const track::Column& c = g.at(limit.column);
      out["quality"]["limits_applied"].push_back({{"column", c.heading()},
                                                  {"unit", c.unit},
                                                  {"level", limit.level},
                                                  {"low", limit.low / c.scale},
                                                  {"high", limit.high / c.scale}});
    }
  }
  const auto add = [&](const char* name, const std::optional<track::Adjustment>& a) {
    if (!a) return;
    out["adjustment"][name] = {{"worst_checks_before_m", a->worst_before},
                               {"worst_checks_after_m", a->worst_after},
                               {"unreachable", a->unreachable}};
  };
  add("slew", r.slew);
  add("lift", r.lift);
  if (r.axis) {
    out["axis"] = {{"elements", r.axis->alignment.horizontal.elements().size()},
                   {"offset_rms_m", r.axis->offset_rms},
                   {"height_rms_m", r.axis->height_rms},
                   {"cant_rms_m", r.axis->cant_rms}};
  }
  return out.dump();
}

std::string geometry_summary_text(const GeometryResult& r) {
  const track::Geometry& g = r.geometry;
  std::string text =
      fmt::format("  geometry: {} points every {:g} m, mileage {:.2f} to {:.2f} m, {} sleepers\n", g.size(), g.step,
                  g.posted_at(g.mileage.front()), g.posted_at(g.mileage.back()), g.sleepers.size());
  if (r.quality) {
    std::map<std::string, int> levels;
    for (const auto& e : r.quality->exceedances) ++levels[e.level];
    text += fmt::format("  quality ({}, {:.0f} km/h):", r.quality->profile, r.quality->speed / units::kmh);
    if (levels.empty()) text += " no exceedance";
    for (const auto& [level, n] : levels) text += fmt::format(" {} x {}", n, level);
    text += "\n";
  }
  if (r.axis) {
    text += fmt::format("  optimal axis: {} elements, offsets {:.2f} mm RMS\n",
                        r.axis->alignment.horizontal.elements().size(), 1e3 * r.axis->offset_rms);
  }
  for (const auto& w : g.record.warnings) text += "  warning: " + w + "\n";
  return text;
}

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
  std::filesystem::path target = output;
  if (target.empty()) {
    target = config.folder.empty() ? std::filesystem::path(job).replace_extension(".result")
                                   : job.parent_path() / config.folder;
  }
  auto folder = io::ResultFolder::create(target);
  if (!folder) return tl::unexpected(folder.error());
  io::Run run;
  run.started_utc = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
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
  ProgressFile visible(progress, folder->folder());
  auto result = compute_track_geometry(config.geometry, trajectory->series, nullptr, odometers, {}, visible);
  if (!result) return tl::unexpected(result.error());
  visible.finish();
  if (auto done = write_track_geometry(config.geometry, *result, *folder, progress); !done)
    return tl::unexpected(done.error());
  run.command = "geometry";
  run.version = version();
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
  GeometryRun out{folder->target(), json::parse(run.results_json).dump(2), geometry_summary_text(*result)};
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
