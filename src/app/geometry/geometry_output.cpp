// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "versine/app/geometry.hpp"
#include "versine/app/slab_adjustment.hpp"
#include "versine/core/parallel.hpp"
#include "versine/core/units.hpp"
#include "versine/io/alignment_csv.hpp"
#include "versine/io/axis_csv.hpp"
#include "versine/io/geometry_csv.hpp"
#include "versine/io/geometry_gis.hpp"
#include "versine/io/geometry_xlsx.hpp"
#include "versine/io/landxml.hpp"

namespace versine::app {
namespace {

using json = nlohmann::ordered_json;
using Writers = std::vector<std::function<Expected<void>()>>;

/// Runs all writers, as many at a time as there are cores, four at most. The first error is the answer.
Expected<void> all_of(const Writers& writers, Progress& progress) {
  std::size_t done = 0;
  std::mutex mutex;  // of all that follows
  Expected<void> answer;
  parallel_for(writers.size(), std::min<std::size_t>(thread_count(0), 4), [&](std::size_t i) {
    {
      const std::scoped_lock lock(mutex);
      if (answer && progress.cancelled()) answer = fail({.found = "cancelled"});
      if (!answer) return;
    }
    auto written = writers[i]();
    const std::scoped_lock lock(mutex);
    if (!written && answer) answer = std::move(written);
    progress.report("writing geometry", double(++done) / double(writers.size()));
  });
  return answer;
}

}  // namespace

Expected<void> write_track_geometry(const GeometryConfig& c, const GeometryResult& r, const io::ResultFolder& folder,
                                    Progress& progress) {
  const track::Geometry& g = r.geometry;
  const track::Quality* quality = r.quality ? &*r.quality : nullptr;
  Writers writers;
  // The long ones first, so that no core is left with one of them at the end.
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
  if (r.axis) {
    writers.emplace_back([&] { return io::write_landxml(folder.path("axis.xml"), *r.axis); });
    writers.emplace_back([&] { return io::write_axis_csv(folder.path("axis.csv"), *r.axis); });
  }
  if (r.fastenings) {
    writers.emplace_back([&] { return io::write_fastenings_csv(folder.path("fastenings.csv"), *r.fastenings); });
    writers.emplace_back([&] {
      return io::write_parts_csv(folder.path("fastening_parts.csv"), *r.fastenings, c.fastenings.lateral.step,
                                 c.fastenings.vertical.step);
    });
  }
  if (r.tie) writers.emplace_back([&] { return write_tie(folder.path("common_points.csv"), *r.tie); });
  return all_of(writers, progress);
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
  if (r.fastenings) out["fastenings"] = json::parse(slab_json(*r.fastenings));
  if (r.tie) out["coordinates"] = json::parse(tie_json(*r.tie));
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
  if (r.fastenings) text += slab_text(*r.fastenings);
  if (r.tie) text += tie_text(*r.tie);
  for (const auto& w : g.record.warnings) text += "  warning: " + w + "\n";
  return text;
}

}  // namespace versine::app
