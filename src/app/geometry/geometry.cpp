// SPDX-License-Identifier: Apache-2.0
#include "versine/app/geometry.hpp"

#include <fmt/format.h>

#include <cmath>

#include "versine/app/geometry_coordinates.hpp"
#include "versine/app/measured_axis.hpp"
#include "versine/app/slab_adjustment.hpp"
#include "versine/io/alignment_file.hpp"
#include "versine/io/read_recording.hpp"
#include "versine/sensors/series_check.hpp"
#include "versine/track/correlated_errors.hpp"

namespace versine::app {
namespace {

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
  if (auto tied = tie_coordinates(config.coordinates, input, out.files); tied)
    out.tie = std::move(*tied);
  else
    return tl::unexpected(tied.error());
  filter::ErrorChain assumed;
  if ((chain == nullptr || chain->empty()) && config.error_correlation > 0.0 && !trajectory.empty() &&
      trajectory.front().position_covariance.xx > 0.0f) {
    assumed = track::correlated_errors(trajectory, config.error_correlation);
    input.chain = &assumed;
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
    if (!input.projection) input.projection = geodesy::Projection::create(geometry->crs).value();
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
  if (config.fastenings.on) {
    auto plans = plan_slab(config.fastenings, out.geometry, out.at_sleepers ? &*out.at_sleepers : nullptr);
    if (!plans) return tl::unexpected(plans.error());
    out.fastenings = std::move(*plans);
  }
  if (config.adjust) {
    if (auto done = adjust(config, out); !done) return tl::unexpected(done.error());
  }
  return out;
}

}  // namespace versine::app
