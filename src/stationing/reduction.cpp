// SPDX-License-Identifier: Apache-2.0
#include "versine/stationing/reduction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sets.hpp"
#include "versine/core/numbers.hpp"
#include "versine/geodesy/attitude.hpp"

namespace versine::stationing {
namespace {

constexpr double earth_radius = 6.371e6;
using geodesy::wrap_pi;

struct Mean {
  double value = nan, spread = nan;
};
Mean mean_of(const std::vector<double>& v) {
  if (v.empty()) return {};
  double sum = 0.0, squares = 0.0;
  for (const double x : v) sum += x - v.front();
  const double mean = v.front() + sum / static_cast<double>(v.size());
  for (const double x : v) squares += (x - mean) * (x - mean);
  return {mean, v.size() < 2 ? nan : std::sqrt(squares / static_cast<double>(v.size() - 1))};
}

Target target_of(const std::vector<const Pointing*>& pointings, const Instrument& instrument) {
  std::vector<double> r, z, d;
  double weight = 0.0;  // in pairs of faces
  Target t;
  for (const Pointing* p : pointings) {
    r.push_back(p->direction);
    z.push_back(p->zenith);
    if (!std::isnan(p->distance)) d.push_back(p->distance);
    weight += p->both() ? 1.0 : 0.5;
    t.readings += p->both() ? 2 : 1;
  }
  const Mean direction = mean_of(r), zenith = mean_of(z), distance = mean_of(d);
  t.direction = wrap_pi(direction.value);
  t.distance = distance.value;
  // Light bends towards the Earth: the target seems higher by k d / 2R.
  const double bent = std::isnan(t.distance) ? 0.0 : instrument.refraction * t.distance / (2.0 * earth_radius);
  t.zenith = zenith.value + bent * std::sin(zenith.value);
  t.direction_sigma = t.zenith_sigma = instrument.angle_sigma / std::sqrt(weight);
  t.distance_sigma =
      instrument.distance_sigma + 1e-6 * instrument.distance_sigma_ppm * t.distance;  // as makers mean it
  t.direction_spread = direction.spread;
  t.zenith_spread = zenith.spread;
  t.distance_spread = distance.spread;
  return t;
}

void warn_about_faces(const Grouped& g, const AxisErrors& axis, const Instrument& instrument, ReducedStation& out) {
  std::size_t single = 0, pairs = 0;
  for (const auto& [number, set] : g.sets) {
    for (const auto& [i, p] : set) p.both() ? ++pairs : ++single;
  }
  if (single > 0 && pairs == 0 && !instrument.one_face && instrument.collimation == 0.0 &&
      instrument.index_error == 0.0) {
    out.warnings.push_back(
        "no target was read in both faces: collimation and index error stay in the readings; measure face II, or give "
        "collimation_arcsec and index_error_arcsec of a calibration");
  } else if (single > 0 && pairs > 0) {
    out.warnings.push_back(
        fmt::format("{} of {} pointings have one face only; corrected with the axis errors of the "
                    "other pointings",
                    single, single + pairs));
  }
  const Mean c = mean_of(axis.collimation);
  if (axis.collimation.size() > 3 && c.spread > 5.0 * instrument.angle_sigma + instrument.target_sigma / 5.0) {
    out.warnings.push_back(fmt::format(
        "collimation scatters by {:.1f}\" among pointings: was the instrument disturbed?", c.spread / units::arcsec));
  }
}

}  // namespace

Expected<ReducedStation> reduce(const Stationing& s, const Instrument& instrument) {
  if (s.sightings.empty()) {
    return fail({.field = fmt::format("station {}", s.name),
                 .found = "no readings",
                 .expected = "at least three targets",
                 .advice = "remove the station, or add its readings"});
  }
  auto g = group_readings(s);
  if (!g) return tl::unexpected(g.error());
  if (auto unit = check_unit(s, *g); !unit) return tl::unexpected(unit.error());

  ReducedStation out{.name = s.name,
                     .mark = s.mark,
                     .instrument_height = s.instrument_height,
                     .from = s.from,
                     .to = s.to,
                     .felt_up = s.felt_up};
  const AxisErrors axis = axis_errors(*g);
  if (!axis.collimation.empty()) {
    out.collimation = median(axis.collimation);
    out.index_error = median(axis.index);
  }
  warn_about_faces(*g, axis, instrument, out);
  merge_faces(s, instrument, out.collimation.value_or(instrument.collimation),
              out.index_error.value_or(instrument.index_error), *g);
  turn_sets(*g);
  out.sets = g->sets.size();
  for (std::size_t i = 0; i < g->points.size(); ++i) {
    const std::size_t dropped = drop_outliers(*g, i, instrument);
    if (dropped == 0) continue;
    out.dropped += dropped;
    out.warnings.push_back(
        fmt::format("point {}: {} readings contradict the other sets and were left out", g->points[i], dropped));
  }
  std::erase_if(g->sets, [](const auto& set) { return set.second.empty(); });
  adjust_sets(*g);
  for (std::size_t i = 0; i < g->points.size(); ++i) {
    std::vector<const Pointing*> pointings;
    for (const auto& [number, set] : g->sets) {
      if (const auto it = set.find(i); it != set.end()) pointings.push_back(&it->second);
    }
    if (pointings.empty()) continue;
    Target t = target_of(pointings, instrument);
    t.point = g->points[i];
    t.target_height = g->target_height[i];
    t.line = g->line[i];
    out.targets.push_back(std::move(t));
  }
  return out;
}

}  // namespace versine::stationing
