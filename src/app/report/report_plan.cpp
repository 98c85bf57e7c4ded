// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "report_reading.hpp"

namespace versine::app {

using json = nlohmann::ordered_json;

namespace {

report::PlanProfile profile_of(const report::RawTable& t, const std::string& prefix = "") {
  report::PlanProfile p;
  const char* directions[] = {"lateral", "vertical", "longitudinal"};
  for (std::size_t i = 0; i < t.rows.size(); ++i) {
    p.distance.push_back(t.number(i, "distance_m"));
    for (std::size_t k = 0; k < 3; ++k) p.sigma[k].push_back(t.number(i, prefix + directions[k] + "_sigma_mm"));
  }
  return p;
}

/// A grid that was written row by row, x fastest.
report::PlanMap map_of(const report::RawTable& t) {
  report::PlanMap m;
  if (t.header.size() < 3) return m;
  for (std::size_t i = 0; i < t.rows.size(); ++i) {
    const double x = t.number(i, t.header[0]), y = t.number(i, t.header[1]);
    if (m.y.empty() || y != m.y.back()) m.y.push_back(y);
    if (m.y.size() == 1) m.x.push_back(x);
    m.sigma.push_back(t.number(i, t.header[2]));
  }
  if (m.sigma.size() != m.x.size() * m.y.size()) return {};
  return m;
}

std::string shown(const json& value, const char* format) {
  return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : "";
}

json part(const json& object, const char* key) {
  return object.contains(key) ? object[key] : json();
}

void read_numbers(const json& results, report::PlanReport& r) {
  r.required_mm = results.value("required_mm", 0.0);
  r.sigma_mm = results.value("sigma_mm", 0.0);
  r.met = results.value("met", false);
  r.answers = {{"question", "answer"},
               {{"plan.required", fmt::format("{:.2f} mm", r.required_mm)},
                {"plan.sigma", fmt::format("{:.2f} mm", r.sigma_mm)},
                {"plan.largest_spacing", shown(part(results, "largest_spacing_m"), "{:.1f} m")},
                {"plan.largest_bias", shown(part(results, "largest_bias_deg_per_h"), "{:.3f}")},
                {"plan.largest_walk", shown(part(results, "largest_random_walk_deg_per_sqrt_h"), "{:.4f}")}}};
  r.grades.header = {"name", "sigma_mm", "largest_spacing_m"};
  for (const json& g : results.value("grades", json::array())) {
    r.grades.rows.push_back(
        {g.value("name", ""), shown(part(g, "sigma_mm"), "{:.2f}"), shown(part(g, "largest_spacing_m"), "{:.1f}")});
  }
  r.method_table.header = {"name", "lateral_mm", "vertical_mm", "longitudinal_mm"};
  for (const json& m : results.value("methods", json::array())) {
    const json worst = m.value("interior_worst", json::object());
    r.method_table.rows.push_back({m.value("name", ""), shown(part(worst, "lateral_mm"), "{:.2f}"),
                                   shown(part(worst, "vertical_mm"), "{:.2f}"),
                                   shown(part(worst, "longitudinal_mm"), "{:.2f}")});
  }
  if (!results.contains("monte_carlo")) return;
  const json& m = results["monte_carlo"];
  const char* directions[] = {"lateral", "vertical", "longitudinal"};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string key = std::string(directions[k]) + "_mm";
    r.rms[k] = m.value("rms", json::object()).value(key, 0.0);
    r.predicted[k] = m.value("predicted", json::object()).value(key, 0.0);
    r.coverage[k] = m.value("coverage", json::object()).value(directions[k], 0.0);
  }
}

void read_sensors(const json& settings, report::PlanReport& r) {
  r.sensors.header = {"key", "value"};
  for (const char* section : {"sensors", "survey"}) {
    const json part_of_settings = settings.value(section, json::object());
    for (const auto& [key, value] : part_of_settings.items()) {
      if (const std::string text = text_of(value); !text.empty()) r.sensors.rows.push_back({key, text});
    }
  }
  r.sensors.rows.push_back({"basis", settings.value("basis", "")});
}

}  // namespace

Expected<report::PlanReport> read_plan_report(const std::filesystem::path& folder, const json& run) {
  report::PlanReport r;
  r.facts = read_facts(folder, run);
  const json results = run.value("results", json::object());
  read_numbers(results, r);
  read_sensors(run.value("settings", json::object()), r);
  std::vector<std::pair<std::string, report::RawTable>> tables;
  for (const char* name : {"interval.csv", "profile.csv", "map_lateral.csv", "map_vertical.csv", "map_longitudinal.csv",
                           "monte_carlo.csv"}) {
    auto raw = read_raw(folder / name);
    if (!raw) return tl::unexpected(raw.error());
    if (raw->rows.empty() && std::string(name) == "profile.csv") {
      return fail({.file = (folder / name).string(),
                   .found = "that it is not there",
                   .expected = "the files of one whole result",
                   .advice = "run the job again, or copy the result folder whole"});
    }
    tables.emplace_back(name, std::move(*raw));
  }
  r.closed = profile_of(tables[0].second, "closed_");
  r.smoothed = profile_of(tables[0].second);
  r.run = profile_of(tables[1].second);
  r.lateral = map_of(tables[2].second);
  r.vertical = map_of(tables[3].second);
  r.longitudinal = map_of(tables[4].second);
  const report::RawTable& errors = tables[5].second;
  for (std::size_t i = 0; i < errors.rows.size(); ++i) {
    r.errors[0].push_back(errors.number(i, "lateral_error_mm"));
    r.errors[1].push_back(errors.number(i, "vertical_error_mm"));
    r.errors[2].push_back(errors.number(i, "longitudinal_error_mm"));
  }
  for (const auto& row : r.method_table.rows) {
    std::string name = row[0];
    std::replace(name.begin(), name.end(), '/', '_');
    auto raw = read_raw(folder / ("method_" + name + ".csv"));
    if (!raw) return tl::unexpected(raw.error());
    r.methods.push_back(profile_of(*raw));
    r.methods.back().name = row[0];
  }
  return r;
}

}  // namespace versine::app
