// SPDX-License-Identifier: Apache-2.0
#include "view_difference.hpp"

#include <fmt/format.h>

#include <cmath>

#include "versine/io/input_stream.hpp"
#include "versine/track/repeatability.hpp"

namespace versine::app {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

/// Columns of a table as track geometry, in the units of the file.
Expected<track::Geometry> geometry_of(const io::GeometryTable& table, const std::vector<std::string>& columns,
                                      double step) {
  std::vector<std::string> names = {"distance_m", "flags"};
  for (const std::string& c : columns) {
    if (!table.has(c)) continue;
    names.push_back(c);
    if (table.has("sigma_" + c)) names.push_back("sigma_" + c);
  }
  auto read = table.read(names);
  if (!read) return tl::unexpected(read.error());
  track::Geometry g;
  g.step = step;
  g.mileage = std::move((*read)[0]);
  g.time.resize(g.mileage.size());
  for (const double f : (*read)[1]) g.flags.push_back(static_cast<std::uint32_t>(f));
  for (std::size_t k = 2; k < names.size(); ++k) {
    if (names[k].starts_with("sigma_")) continue;
    const bool sigma = k + 1 < names.size() && names[k + 1].starts_with("sigma_");
    // track's algorithms know a column by its name without unit.
    track::Column& c = g.columns.emplace_back();
    const auto unit = names[k].ends_with("_mm_per_m") ? 9 : names[k].ends_with("_mm") ? 3 : 0;
    c.name = names[k].substr(0, names[k].size() - static_cast<std::size_t>(unit));
    c.description = names[k];
    c.value = std::move((*read)[k]);
    if (sigma) c.sigma.assign((*read)[k + 1].begin(), (*read)[k + 1].end());
  }
  return g;
}

}  // namespace

Expected<ViewDifference> difference_of(const SurveyFiles& files, const io::GeometryTable& table,
                                       const std::vector<ViewStrip>& strips, const fs::path& other) {
  const auto text = io::read_text(other / "run.json");
  if (!text) return tl::unexpected(text.error());
  const json run = json::parse(*text, nullptr, false);
  if (run.is_discarded()) {
    return fail(
        {.file = (other / "run.json").string(), .found = "text that is no JSON", .advice = "run that job again"});
  }
  const json all = run.value("results", json::object());
  const json results = all.contains("geometry") ? all["geometry"] : all;
  const double step = files.results.value("step_m", 0.25), other_step = results.value("step_m", 0.25);
  if (std::abs(step - other_step) > 1e-9) {
    return fail({.file = other.string(),
                 .field = "geometry.step_m",
                 .found = fmt::format("{:g} m", other_step),
                 .expected = fmt::format("{:g} m as in {}", step, files.folder.string()),
                 .advice = "run one of the jobs again with the same step: --set geometry.step_m=..."});
  }
  const auto other_table = io::GeometryTable::open(other / "geometry.csv");
  if (!other_table) return tl::unexpected(other_table.error());
  std::vector<std::string> columns;
  for (const ViewStrip& s : strips) {
    if (table.has(s.id) && other_table->has(s.id)) columns.push_back(s.id);
  }
  const auto reference = geometry_of(table, columns, step);
  if (!reference) return tl::unexpected(reference.error());
  const auto moved = geometry_of(*other_table, columns, step);
  if (!moved) return tl::unexpected(moved.error());
  const auto shifts = track::find_shifts(*reference, *moved);
  const track::Geometry aligned = track::aligned_to(*reference, *moved, shifts);
  ViewDifference out;
  out.title = run.value("settings", json::object()).value("title", "");
  if (out.title.empty()) out.title = fs::absolute(other).lexically_normal().filename().string();
  const auto statistics = track::compare(*reference, aligned);
  const auto places = std::make_shared<const std::vector<double>>(reference->mileage);
  for (const ViewStrip& s : strips) {
    const auto find = [&](const track::Geometry& g) {
      return std::find_if(g.columns.begin(), g.columns.end(),
                          [&](const track::Column& c) { return c.description == s.id; });
    };
    const auto mine = find(*reference), theirs = find(aligned);
    if (mine == reference->columns.end() || theirs == aligned.columns.end()) continue;
    std::vector<double> value(mine->value.size()), sigma, their_sigma(theirs->sigma.begin(), theirs->sigma.end());
    for (std::size_t i = 0; i < value.size(); ++i) {
      value[i] = mine->value[i] - theirs->value[i];
      if (!mine->sigma.empty() && !their_sigma.empty()) sigma.push_back(std::hypot(mine->sigma[i], their_sigma[i]));
    }
    out.series.emplace_back("compare:" + s.id, ViewSeries(places, theirs->value, their_sigma));
    if (s.tab != "strips") continue;
    ViewStrip strip = s;
    strip.id = "difference:" + s.id;
    strip.tab = "difference";
    strip.companion.clear();
    for (const auto& r : statistics) {
      if (r.column == mine->name) strip.note = fmt::format("RMS {:.2f}, 95 % {:.2f}", r.rms, r.p95);
    }
    out.series.emplace_back(strip.id, ViewSeries(places, value, sigma));
    out.strips.push_back(std::move(strip));
  }
  if (out.strips.empty()) {
    return fail({.file = other.string(),
                 .found = "no column that both results have",
                 .expected = "two results of the same kind",
                 .advice = "compare results of surveys with [geometry]"});
  }
  return out;
}

}  // namespace versine::app
