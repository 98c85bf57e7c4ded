// SPDX-License-Identifier: Apache-2.0
#include "versine/track/compute.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "parameters.hpp"
#include "versine/core/numbers.hpp"
#include "versine/design/alignment.hpp"
#include "versine/track/sleepers.hpp"

namespace versine::track {
namespace {

DesignGrid design_on(const GeometryInput& input, const RunMileage& run, RailGrid& rails,
                     const GeometryOptions& options) {
  DesignGrid out;
  if (input.design == nullptr) return out;
  const double length = input.design->length();
  std::size_t k = 0;
  for (std::size_t i = 0; i < rails.mileage.size(); ++i) {
    const double m = rails.mileage[i];
    const design::DesignPoint p = input.design->at(m);
    out.easting.push_back(p.easting);
    out.northing.push_back(p.northing);
    out.heading.push_back(p.heading);
    out.curvature.push_back(p.curvature);
    out.height.push_back(p.height);
    out.cant.push_back(p.cant);
    while (k + 1 < run.mileage.size() && run.mileage[k] < m) ++k;
    if (m < 0.0 || m > length || !(std::abs(run.offset[k]) <= options.max_offset)) rails.flags[i] |= off_design;
  }
  return out;
}

std::vector<PostedMileage> posted_of(const design::Alignment& design) {
  std::vector<PostedMileage> out;
  for (const auto& e : design.chainage.equations()) out.push_back({e.distance, e.mileage, e.increasing});
  return out;
}

void find_sleepers_of(const GeometryInput& input, const RunMileage& run, Geometry& out) {
  if (input.range.empty()) return;
  const bool reversed = run.epoch.front() > run.epoch.back();
  const double shift = run.direction * (input.trolley.range_x - input.trolley.other_x);
  std::vector<double> s, range;
  std::size_t k = 0;
  const auto at = [&](std::size_t i) { return reversed ? run.epoch.size() - 1 - i : i; };
  for (const auto& r : input.range) {
    while (k + 2 < run.epoch.size() && (*input.trajectory)[run.epoch[at(k + 1)]].time <= r.time) ++k;
    const Time a = (*input.trajectory)[run.epoch[at(k)]].time, b = (*input.trajectory)[run.epoch[at(k + 1)]].time;
    if (r.time < a || b < r.time) continue;
    const double f = (r.time - a).seconds() / (b - a).seconds();
    const double m = run.mileage[at(k)] + f * (run.mileage[at(k + 1)] - run.mileage[at(k)]) + shift;
    if (!s.empty() && (reversed ? !(m < s.back()) : !(m > s.back()))) continue;
    s.push_back(m);
    range.push_back(r.range);
  }
  if (reversed) {
    std::reverse(s.begin(), s.end());
    std::reverse(range.begin(), range.end());
  }
  SleeperResult found = find_sleepers(s, range);
  out.record.warnings.push_back(fmt::format("sleepers: {} found, {} of them mended, {} false detections left out",
                                            found.sleepers.size(), found.mended, found.rejected));
  out.sleepers = std::move(found.sleepers);
}

void describe_conventions(const GeometryInput& input, const GeometryOptions& o, const RailGrid& rails, Geometry& out) {
  out.conventions = {
      {"lateral", "positive to the right in the direction of increasing mileage"},
      {"vertical", "positive upwards"},
      {"cross level", fmt::format("positive: left rail higher; over {:.0f} mm", 1e3 * o.rail_distance)},
      {"curvature", "positive in a right-hand curve"},
      {"versine", "positive: rail right of (above) the chord"},
      {"twist", "(D(s) - D(s - l)) / l, cant ramps included"},
      {"rail point", o.rail_point == RailPoint::head_centre ? "head centre" : "gauge corner, in the running plane"},
      {"rail height", "running surface at the head centre"},
      {"design height", input.design == nullptr                       ? "no design"
                        : o.height_reference == HeightReference::axis ? "of the track axis"
                                                                      : "of the lower rail"},
      {"reference rail of the trolley", rails.reference_is_left ? "left" : "right"},
      {"mileage", input.design != nullptr ? "map metres along the design axis" : "metres along the run"},
      {"bands",
       fmt::format("Butterworth band-pass, prototype order {}, forward and backward, -3 dB at the edges in total",
                   o.filter_order)}};
}

void note_flags(Geometry& out) {
  const auto count = [&](Flag flag) {
    return std::count_if(out.flags.begin(), out.flags.end(), [&](std::uint32_t f) { return (f & flag) != 0; });
  };
  const std::pair<Flag, const char*> told[] = {{no_gauge, "without gauge: the axis is placed by the nominal gauge"},
                                               {no_trajectory, "inside gaps of the trajectory: no values"},
                                               {off_design, "off the design: no deviations"},
                                               {repeated, "passed more than once: the first pass is used"},
                                               {few_samples,
                                                "with too few poses for the fit, which was widened there: ask for a "
                                                "higher rate of the trajectory"}};
  for (const auto& [flag, text] : told) {
    if (const auto n = count(flag); n > 0) {
      out.record.warnings.push_back(fmt::format("{:.2f} m of track {}", double(n) * out.step, text));
    }
  }
}

}  // namespace

Expected<geodesy::ProjectMap> map_of(const GeometryInput& input) {
  const auto projection = [&]() -> Expected<geodesy::Projection> {
    if (input.projection) return *input.projection;
    if (input.design == nullptr) return geodesy::Projection::utm(input.trajectory->front().position);
    if (!input.design->crs.empty()) return geodesy::Projection::create(input.design->crs);
    return fail({.field = "design",
                 .found = fmt::format("alignment '{}' without coordinate system", input.design->name),
                 .expected = "a design whose coordinate system is known",
                 .advice = "name it in the job (geometry.crs = \"EPSG:...\")"});
  }();
  if (!projection) return tl::unexpected(projection.error());
  return geodesy::ProjectMap{*projection, input.similarity, input.heights};
}

Expected<Geometry> compute_geometry(const GeometryInput& input, const GeometryOptions& options, Progress& progress) {
  if (input.trajectory == nullptr) throw std::invalid_argument("compute_geometry: no trajectory");
  if (input.trajectory->size() < 2) {
    return fail({.field = "trajectory",
                 .found = "fewer than two points",
                 .expected = "a run",
                 .advice = "check the trajectory's file"});
  }
  if (!input.trajectory->strictly_increasing()) {
    return fail({.field = "trajectory",
                 .found = "times that do not increase",
                 .expected = "points in order of time",
                 .advice = "sort the file by time and remove duplicates"});
  }
  const auto map = map_of(input);
  if (!map) return tl::unexpected(map.error());
  auto run = synchronise_mileage(input, options, *map, options.step / 20.0);
  if (!run) return tl::unexpected(run.error());
  RailGrid rails = place_rails(input, options, *map, *run, progress);
  if (progress.cancelled()) return fail({.field = "geometry", .found = "cancelled"});
  const DesignGrid design = design_on(input, *run, rails, options);

  Geometry out;
  out.step = options.step;
  out.mileage = rails.mileage;
  out.time = rails.time;
  out.time_scale = input.trajectory->scale;
  out.crs = map->projection.definition();
  out.own_grid = map->similarity.has_value();
  out.height_datum = input.height_datum;
  out.origin = input.trajectory->origin;
  out.record = run->record;
  if (input.design != nullptr) out.posted = posted_of(*input.design);
  out.columns.reserve(128);
  RelativeSigma relative(input, options, *run, rails);
  out.flags = rails.flags;
  Stage stage{input, options, *run, rails, design, relative, out};
  add_coordinates(stage);
  add_curvature_and_gradient(stage);
  add_gauge_cross_level_twist(stage);
  add_deviations(stage);
  add_bands(stage);
  add_versines(stage);
  add_checks(stage);
  find_sleepers_of(input, *run, out);
  describe_conventions(input, options, rails, out);
  note_flags(out);
  if (!relative.known()) {
    out.record.warnings.push_back(
        "no joint errors with the trajectory: versines, checks, bands and twist have no sigma");
  }
  progress.report("geometry", 1.0);
  return out;
}

}  // namespace versine::track
