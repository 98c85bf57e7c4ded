// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "report_reading.hpp"
#include "versine/io/geometry_table.hpp"

namespace versine::app {

using json = nlohmann::ordered_json;

namespace {

Error half_a_result(const std::filesystem::path& file, std::string found) {
  return {.file = file.string(),
          .found = std::move(found),
          .expected = "the files of one whole result",
          .advice = "run the job again, or copy the result folder whole"};
}

/// "gauge_mm" without its unit "mm", "twist_3m_mm_per_m" without "mm/m".
std::string base_of(const std::string& heading, const std::string& unit) {
  std::string shown;
  for (const char c : unit) shown += c == '/' ? std::string("_per_") : std::string(1, c);
  if (shown.starts_with("1_")) shown.erase(0, 2);
  const bool ends = !shown.empty() && heading.ends_with("_" + shown);
  return ends ? heading.substr(0, heading.size() - shown.size() - 1) : heading;
}

/// What strips, summary and curve register show; the rest of 114 columns stays unread.
bool wanted(const std::string& base) {
  for (const char* head :
       {"gauge", "cross_level", "twist_", "level_", "alignment_", "deviation_", "curvature", "versine_lateral_left_",
        "versine_lateral_right_", "versine_vertical_left_", "versine_vertical_right_"}) {
    if (base.starts_with(head)) return true;
  }
  return base == "height_axis";
}

Expected<void> read_geometry(const std::filesystem::path& folder, report::SurveyReport& r) {
  const auto columns = read_raw(folder / "geometry_columns.csv");
  if (!columns) return tl::unexpected(columns.error());
  if (columns->rows.empty()) {
    return tl::unexpected(half_a_result(folder / "geometry_columns.csv", "geometry.csv without its list of columns"));
  }
  auto table = io::GeometryTable::open(folder / "geometry.csv");
  if (!table) return tl::unexpected(table.error());
  std::vector<std::string> asked{"distance_m", "mileage_m"};
  const bool placed = table->has("easting_axis_m") && table->has("northing_axis_m");
  if (placed) asked.insert(asked.end(), {"easting_axis_m", "northing_axis_m"});
  struct Wanted {
    std::string base, unit;
    std::size_t value, sigma;
  };
  std::vector<Wanted> plan;
  for (std::size_t i = 0; i < columns->rows.size(); ++i) {
    const std::string &heading = columns->at(i, "column"), &unit = columns->at(i, "unit");
    const std::string base = base_of(heading, unit);
    if (!wanted(base) || !table->has(heading)) continue;
    Wanted w{base, unit, asked.size(), 0};
    asked.push_back(heading);
    if (table->has("sigma_" + heading)) {
      w.sigma = asked.size();
      asked.push_back("sigma_" + heading);
    }
    plan.push_back(std::move(w));
  }
  auto values = table->read(asked);
  if (!values) return tl::unexpected(values.error());
  r.distance = std::move((*values)[0]);
  r.posted = std::move((*values)[1]);
  if (r.distance.size() < 2) {
    return tl::unexpected(half_a_result(folder / "geometry.csv", fmt::format("{} points", r.distance.size())));
  }
  for (std::size_t i = 0; placed && i < r.distance.size(); ++i) r.axis.push_back({(*values)[2][i], (*values)[3][i]});
  for (const Wanted& w : plan) {
    report::Quantity q{w.base, w.unit, std::move((*values)[w.value]), {}};
    if (w.sigma > 0) q.sigma = std::move((*values)[w.sigma]);
    r.quantities.push_back(std::move(q));
  }
  return {};
}

/// Map and strips of a result without geometry: about two thousand points of trajectory.csv.
Expected<void> read_trajectory(const std::filesystem::path& folder, report::SurveyReport& r) {
  std::error_code code;
  const auto path = folder / "trajectory.csv";
  const auto bytes = std::filesystem::file_size(path, code);
  if (code) return {};
  // A line has some 230 bytes.
  const std::size_t every = std::max<std::size_t>(1, static_cast<std::size_t>(bytes) / 230 / 4000);
  std::size_t line = 0;
  const auto table = TextTable::read(path, ',', [&](std::string_view) { return line++ % every == 0; });
  if (!table) return tl::unexpected(table.error());
  report::RawTable raw{table->header, table->rows};
  const struct {
    const char *column, *base, *unit, *sigma;
  } shown[] = {{"height_m", "height", "m", "sigma_down_m"}, {"roll_deg", "roll", "deg", ""},
               {"pitch_deg", "pitch", "deg", ""},           {"heading_deg", "heading", "deg", ""},
               {"sigma_north_m", "sigma_north", "m", ""},   {"sigma_east_m", "sigma_east", "m", ""},
               {"sigma_down_m", "sigma_down", "m", ""}};
  report::Quantity speed{"speed", "m/s", {}, {}};
  for (std::size_t i = 0; i < raw.rows.size(); ++i) {
    r.time.push_back(raw.number(i, "time_s") - raw.number(0, "time_s"));
    r.axis.push_back({raw.number(i, "easting_m"), raw.number(i, "northing_m")});
    speed.value.push_back(std::hypot(raw.number(i, "velocity_north_mps"), raw.number(i, "velocity_east_mps")));
  }
  r.trajectory.push_back(std::move(speed));
  for (const auto& s : shown) {
    if (!raw.has(s.column)) continue;
    report::Quantity q{s.base, s.unit, {}, {}};
    for (std::size_t i = 0; i < raw.rows.size(); ++i) {
      q.value.push_back(raw.number(i, s.column));
      if (raw.has(s.sigma)) q.sigma.push_back(raw.number(i, s.sigma));
    }
    r.trajectory.push_back(std::move(q));
  }
  return {};
}

void read_quality(const json& geometry, report::SurveyReport& r) {
  const auto it = geometry.find("quality");
  if (it == geometry.end()) return;
  const json& q = *it;
  r.limits = q.value("limits", "");
  r.limits_source = q.value("source", "");
  r.speed_kmh = q.value("speed_kmh", 0.0);
  r.tqi_limit_mm = q.value("tqi_limit_mm", 0.0);
  r.levels = q.value("levels", std::vector<std::string>{});
  r.unchecked = q.value("unchecked", std::vector<std::string>{});
  for (const json& l : q.value("limits_applied", json::array())) {
    report::SurveyLimit limit{base_of(l.value("column", ""), l.value("unit", "")), l.value("level", "")};
    const auto level = std::find(r.levels.begin(), r.levels.end(), limit.level);
    limit.severity = static_cast<int>(level - r.levels.begin());
    limit.low = l["low"].is_number() ? l["low"].get<double>() : -HUGE_VAL;
    limit.high = l["high"].is_number() ? l["high"].get<double>() : HUGE_VAL;
    r.applied.push_back(std::move(limit));
  }
}

/// The head of adjustment.csv says in words what its signs mean.
std::vector<std::string> comments_of(const std::filesystem::path& path) {
  std::vector<std::string> out;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line) && line.starts_with("#");) out.push_back(line.substr(2));
  return out;
}

Expected<void> read_tables(const std::filesystem::path& folder, const json& geometry_settings,
                           report::SurveyReport& r) {
  const std::string delimiter = geometry_settings.value("/adjustment/delimiter"_json_pointer, std::string(","));
  const std::pair<const char*, report::RawTable*> tables[] = {{"exceedances.csv", &r.exceedances},
                                                              {"sections.csv", &r.sections},
                                                              {"design_elements.csv", &r.elements},
                                                              {"landmarks.csv", &r.landmarks},
                                                              {"adjustment.csv", &r.adjustment}};
  for (const auto& [name, table] : tables) {
    const bool free = table == &r.adjustment && delimiter.size() == 1;
    auto raw = read_raw(folder / name, free ? delimiter[0] : ',');
    if (!raw) return tl::unexpected(raw.error());
    *table = std::move(*raw);
  }
  r.adjustment_notes = comments_of(folder / "adjustment.csv");
  return {};
}

void read_numbers(const json& results, const json& geometry, report::SurveyReport& r) {
  if (geometry.contains("points")) {
    r.key_numbers.emplace_back("cover.points",
                               fmt::format("{} x {:g} m", geometry.value("points", 0), geometry.value("step_m", 0.0)));
    r.key_numbers.emplace_back("cover.sleepers", text_of(geometry.value("sleepers", json(0))));
  }
  if (results.contains("duration_s")) {
    r.key_numbers.emplace_back("cover.duration", fmt::format("{:.0f} s, {:.1f} m", results.value("duration_s", 0.0),
                                                             results.value("length_m", 0.0)));
  }
  if (results.contains("sigma_horizontal_rms_m")) {
    r.key_numbers.emplace_back(
        "cover.sigma_horizontal",
        fmt::format("{:.2f} mm (RMS), {:.2f} mm (max)", 1e3 * results.value("sigma_horizontal_rms_m", 0.0),
                    1e3 * results.value("sigma_horizontal_max_m", 0.0)));
    r.key_numbers.emplace_back("cover.sigma_vertical",
                               fmt::format("{:.2f} mm", 1e3 * results.value("sigma_vertical_max_m", 0.0)));
  }
  r.innovations.header = {"sensor", "used", "rejected", "mean_nis_per_row", "lower", "upper"};
  for (const json& i : results.value("innovations", json::array())) {
    r.innovations.rows.push_back(
        {i.value("sensor", ""), text_of(i.value("used", json())), text_of(i.value("rejected", json())),
         fmt::format("{:.3f}", i.value("mean_nis_per_row", 0.0)), fmt::format("{:.3f}", i.value("lower", 0.0)),
         fmt::format("{:.3f}", i.value("upper", 0.0))});
  }
}

}  // namespace

Expected<report::SurveyReport> read_survey_report(const std::filesystem::path& folder, const json& run) {
  report::SurveyReport r;
  r.facts = read_facts(folder, run);
  const json results = run.value("results", json::object());
  // A geometry job's own results are what a survey has under "geometry".
  const json geometry = run.value("command", "") == "geometry" ? results : results.value("geometry", json::object());
  const json settings = run.value("settings", json::object());
  const bool measured = geometry.contains("points");
  if (measured && !std::filesystem::exists(folder / "geometry.csv")) {
    const bool asked = settings.value("/geometry/write/csv"_json_pointer, true);
    return tl::unexpected(asked ? half_a_result(folder / "geometry.csv", "that it is not there")
                                : Error{.file = folder.string(),
                                        .field = "geometry.write.csv",
                                        .found = "false: no geometry.csv",
                                        .expected = "geometry.csv, which the report shows",
                                        .advice = "set geometry.write.csv = true and run the job again"});
  }
  if (measured) {
    if (auto done = read_geometry(folder, r); !done) return tl::unexpected(done.error());
  } else if (auto done = read_trajectory(folder, r); !done) {
    return tl::unexpected(done.error());
  }
  r.crs = geometry.value("crs", results.value("crs", ""));
  r.height_datum = geometry.value("height_datum", "ellipsoidal");
  r.origin = settings.value("method", "") == "landmark" ? "landmark dead reckoning"
             : run.value("command", "") == "geometry"   ? settings.value("/trajectory/file"_json_pointer, std::string())
                                                        : "aided INS, smoothed";
  const json conventions = geometry.value("conventions", json::object());
  for (const auto& [what, how] : conventions.items()) {
    r.conventions.emplace_back(what, text_of(how));
  }
  read_quality(geometry, r);
  if (auto done = read_tables(folder, settings.value("geometry", json::object()), r); !done) {
    return tl::unexpected(done.error());
  }
  read_numbers(results, geometry, r);
  return r;
}

}  // namespace versine::app
