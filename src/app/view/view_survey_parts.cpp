// SPDX-License-Identifier: Apache-2.0
#include "view_survey_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "job/text_table.hpp"
#include "versine/core/units.hpp"
#include "versine/geodesy/projection.hpp"
#include "versine/io/input_stream.hpp"
#include "versine/track/geometry.hpp"

namespace versine::app {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

json number_or_null(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

std::string view_frame(const char* kind, const SurveyFiles& files, const std::string& crs, const std::string& subtitle,
                       json verdict, json survey) {
  const json settings = files.run.value("settings", json::object());
  std::string title = settings.value("title", "");
  if (title.empty()) title = files.folder.filename().string();
  json rejections = json::array();
  constexpr std::size_t shown = 500;  // rejections.csv holds them all
  for (const json& r : files.run.value("rejections", json::array())) {
    if (rejections.size() < shown) rejections.push_back(r);
  }
  json out{{"kind", kind},
           {"title", title},
           {"subtitle", subtitle},
           {"folder", files.folder.filename().string()},
           {"version", files.run.value("version", "")},
           {"started", files.run.value("started_utc", "")},
           {"crs", crs},
           {"report", fs::exists(files.folder / "report.html")},
           {"verdict", std::move(verdict)},
           {"warnings", files.run.value("warnings", json::array())},
           {"findings", files.run.value("findings", json::array())},
           {"rejections", std::move(rejections)},
           {"rejected", files.run.value("rejections", json::array()).size()}};
  const std::string partial = files.run.value("results", json::object()).value("partial", "");
  if (!partial.empty()) out["partial"] = partial;
  out[kind] = std::move(survey);
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::function<std::optional<std::string>()> report_of(const fs::path& folder) {
  return [path = folder / "report.html"]() -> std::optional<std::string> {
    auto text = io::read_text(path);
    return text ? std::optional(std::move(*text)) : std::nullopt;
  };
}

namespace {

/// The page draws three classes; a profile's severest level is drawn as the severest of them.
const char* class_of(std::size_t severity, std::size_t levels) {
  static constexpr const char* classes[] = {"AL", "IL", "IAL"};
  const std::size_t from_worst = levels - 1 - std::min(severity, levels - 1);
  return classes[from_worst > 2 ? 0 : 2 - from_worst];
}

const char* class_of_level(const SurveyFiles& files, const std::string& level) {
  const auto& quality = files.results.value("quality", json::object());
  const auto levels = quality.value("levels", std::vector<std::string>{});
  const auto at = static_cast<std::size_t>(std::find(levels.begin(), levels.end(), level) - levels.begin());
  return levels.empty() ? "AL" : class_of(at, levels.size());
}

}  // namespace

std::map<std::string, json> limits_by_column(const SurveyFiles& files) {
  std::map<std::string, json> out;
  for (const json& limit : files.results.value("quality", json::object()).value("limits_applied", json::array())) {
    const std::string level = limit.value("level", "");
    out[limit.value("column", "")].push_back({{"level", level},
                                              {"class", class_of_level(files, level)},
                                              {"low", limit.value("low", json())},
                                              {"high", limit.value("high", json())}});
  }
  return out;
}

json verdict_of(const SurveyFiles& files) {
  const json quality = files.results.value("quality", json());
  if (!quality.is_object()) return {{"accepted", nullptr}, {"text", "NOT JUDGED: no limits"}};
  const auto levels = quality.value("levels", std::vector<std::string>{});
  const json counts = quality.value("exceedances", json::object());
  std::string text;
  for (auto it = levels.rbegin(); it != levels.rend(); ++it) {
    if (counts.contains(*it)) text += fmt::format(" · {} {}", counts[*it].get<int>(), *it);
  }
  const bool accepted = levels.empty() || !counts.contains(levels.back());
  return {{"accepted", accepted},
          {"text", (accepted ? "ACCEPTED" : "NOT ACCEPTED") + text},
          {"profile", quality.value("limits", "")},
          {"source", quality.value("source", "")}};
}

Expected<json> exceedances_of(const SurveyFiles& files, const std::vector<ViewStrip>& strips) {
  json out = json::array();
  const fs::path path = files.folder / "exceedances.csv";
  if (!fs::exists(path)) return out;
  const auto table = TextTable::read(path);
  if (!table) return tl::unexpected(table.error());
  const auto column = table->find("column"), unit = table->find("unit"), level = table->find("level");
  if (!column || !unit || !level || !table->find("peak_distance_m")) {
    return fail({.file = path.string(),
                 .line = 1,
                 .found = "a header without column, unit, level or peak_distance_m",
                 .expected = "the table that this version writes",
                 .advice = "run the job again with this version"});
  }
  for (const auto& row : table->rows) {
    const auto number = [&](const char* name) { return TextTable::number(row, table->find(name)); };
    const std::string id = track::Column{.name = row[*column], .unit = row[*unit]}.heading();
    const auto strip = std::find_if(strips.begin(), strips.end(), [&](const ViewStrip& s) { return s.id == id; });
    out.push_back({{"strip", id},
                   {"title", strip == strips.end() ? row[*column] : strip->title},
                   {"note", strip == strips.end() ? "" : strip->note},
                   {"level", row[*level]},
                   {"class", class_of_level(files, row[*level])},
                   {"start", number("start_distance_m")},
                   {"end", number("end_distance_m")},
                   {"peakAt", number("peak_distance_m")},
                   {"peak", number("value")},
                   {"limit", number("limit")},
                   {"sigma", number_or_null(number("sigma"))},
                   {"probability", number_or_null(number("probability_over"))},
                   {"digits", strip == strips.end() ? 1 : strip->digits},
                   {"unit", row[*unit]}});
  }
  return out;
}

json chainage_of(const SurveyFiles& files, const SurveyGrid& grid) {
  json out = json::array();
  const double first = grid.x->front(), last = grid.x->back();
  const json posted = files.results.value("posted", json::array());
  for (std::size_t i = 0; i < posted.size(); ++i) {
    const double start = posted[i].value("start_m", 0.0);
    const double end = i + 1 < posted.size() ? posted[i + 1].value("start_m", 0.0) : last;
    const int sign = posted[i].value("increasing", true) ? 1 : -1;
    const double from = i == 0 ? first : std::max(start, first), to = std::min(end, last);
    if (!(to >= from) || (to == from && i > 0)) continue;
    out.push_back({{"from", from},
                   {"to", to},
                   {"posted", posted[i].value("posted_m", 0.0) + sign * (from - start)},
                   {"sign", sign}});
  }
  if (out.empty()) out.push_back({{"from", first}, {"to", last}, {"posted", grid.mileage.front()}, {"sign", 1}});
  return out;
}

json plan_of(const std::string& crs, const std::vector<double>& x, const std::vector<double>& easting,
             const std::vector<double>& northing) {
  json out = json::array();
  const auto projection = geodesy::Projection::create(crs);
  const std::size_t stride = std::max<std::size_t>(1, x.size() / 4000);
  json line;
  const auto close = [&] {
    if (line.is_object() && line["x"].size() > 1) out.push_back(std::move(line));
    line = json();
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(easting[i]) || !std::isfinite(northing[i])) {
      close();
      continue;
    }
    const bool last = i + 1 == x.size() || !std::isfinite(easting[i + 1]);
    if (line.is_object() && !last && i % stride != 0) continue;
    if (!line.is_object()) line = {{"x", json::array()}, {"easting", json::array()}, {"northing", json::array()}};
    line["x"].push_back(x[i]);
    line["easting"].push_back(easting[i]);
    line["northing"].push_back(northing[i]);
    if (projection) {
      const auto place = projection->inverse({easting[i], northing[i], 0.0});
      line["latitude"].push_back(number_or_null(place.latitude / units::deg));
      line["longitude"].push_back(number_or_null(place.longitude / units::deg));
    }
  }
  close();
  return out;
}

Expected<json> control_points_of(const SurveyFiles& files, const SurveyGrid& grid) {
  json out = json::array();
  const fs::path path = files.folder / "innovations.csv";
  if (!fs::exists(path)) return out;
  const auto table = TextTable::read(
      path, ',', [](std::string_view line) { return line.find(",landmark,") != std::string_view::npos; });
  if (!table) return tl::unexpected(table.error());
  const auto component = table->find("component"), used = table->find("used");
  if (!component || !used) return out;
  for (const auto& row : table->rows) {
    const double time = TextTable::number(row, table->find("time_s"));
    if (out.empty() || out.back()["time"] != time) {
      // The beam's place at that time; standing still, the first point that was reached then.
      const auto it = std::lower_bound(grid.time_s.begin(), grid.time_s.end(), time);
      const auto i = std::min(static_cast<std::size_t>(it - grid.time_s.begin()), grid.x->size() - 1);
      out.push_back({{"name", fmt::format("{}", out.size() + 1)},
                     {"x", (*grid.x)[i]},
                     {"time", time},
                     {"innovation", json::array({nullptr, nullptr, nullptr})},
                     {"sigma", json::array({nullptr, nullptr, nullptr})},
                     {"nis", number_or_null(TextTable::number(row, table->find("nis")))},
                     {"used", row[*used] == "1"}});
    }
    const auto k = static_cast<std::size_t>(TextTable::number(row, component));
    if (k > 2) continue;
    out.back()["innovation"][k] = number_or_null(1e3 * TextTable::number(row, table->find("innovation")));
    out.back()["sigma"][k] = number_or_null(1e3 * TextTable::number(row, table->find("sigma")));
  }
  return out;
}

Expected<std::vector<AdjustmentSeries>> adjustment_of(const SurveyFiles& files, const SurveyGrid& grid) {
  std::vector<AdjustmentSeries> out;
  const fs::path path = files.folder / "adjustment.csv";
  if (!fs::exists(path)) return out;
  const json settings = files.settings.value("adjustment", json::object());
  const std::string delimiter = settings.value("delimiter", ",");
  const auto table = TextTable::read(path, delimiter.empty() ? ',' : delimiter.front());
  if (!table) return tl::unexpected(table.error());
  const double step = files.results.value("step_m", 0.25), interval = settings.value("interval_m", 2.5);
  const auto stride = std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(interval / step)));
  auto x = std::make_shared<std::vector<double>>();
  for (std::size_t i = 0; i < grid.x->size() && x->size() < table->rows.size(); i += stride) x->push_back((*grid.x)[i]);
  const char point = settings.value("decimal_comma", false) ? ',' : '.';
  const bool right = settings.value("slew_right_positive", true);
  for (const auto& [id, title, positive] : {std::tuple{"slew_mm", "Slew", right ? "+ to the right" : "+ to the left"},
                                            {"slew_left_over_mm", "Left from design", right ? "+ right" : "+ left"},
                                            {"lift_mm", "Lift", "+ up"},
                                            {"lift_left_over_mm", "Left from height", "+ up"}}) {
    const auto column = table->find(id);
    if (!column) continue;
    std::vector<double> value;
    for (std::size_t i = 0; i < x->size(); ++i) value.push_back(TextTable::number(table->rows[i], column, point));
    out.push_back({{.id = std::string("adjustment:") + id,
                    .title = title,
                    .note = fmt::format("every {:g} m", interval),
                    .unit = "mm",
                    .positive = positive,
                    .tab = "adjustment"},
                   ViewSeries(x, value, {})});
  }
  return out;
}

}  // namespace versine::app
