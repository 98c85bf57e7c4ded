// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "colours.hpp"
#include "survey_parts.hpp"
#include "versine/report/figure.hpp"

namespace versine::report {

namespace {

std::string with_unit(const Texts& t, const char* key, const char* unit) {
  return t(key) + ", " + t.phrase(unit);
}

/// "98.6 %" of 0.9859; nothing of an empty field.
std::string percent(const RawTable& raw, std::size_t row, const std::string& column) {
  const double p = raw.number(row, column);
  return std::isfinite(p) ? fmt::format("{:.1f}", 100.0 * p) : "";
}

/// Mean of a quantity between two distances; NaN without values.
double mean_between(const SurveyReport& r, const char* column, double from, double to) {
  const Quantity* q = r.find(column);
  if (q == nullptr) return std::nan("");
  double sum = 0.0, n = 0.0;
  for (std::size_t i = 0; i < r.distance.size(); ++i) {
    if (r.distance[i] < from || r.distance[i] > to || !std::isfinite(q->value[i])) continue;
    sum += q->value[i];
    n += 1.0;
  }
  return n > 0.0 ? sum / n : std::nan("");
}

std::string radius_text(double radius) {
  return std::isfinite(radius) ? fmt::format("{:.2f}", radius) : "";
}

/// The place column of a raw table as 12+345.25.
std::string place(const RawTable& raw, std::size_t i, const std::string& column) {
  return place_text(raw.number(i, column), 2);
}

Figure residual_figure(const SurveyReport& r, const Texts& t) {
  Figure f{.title = t("control.figure"),
           .x = {.label = t("control.number"), .low = 0.0, .high = static_cast<double>(r.landmarks.rows.size() + 1)},
           .y = {.label = t("control.residual_mm")}};
  const std::pair<const char*, const char*> parts[] = {
      {"residual_north_mm", "control.north"}, {"residual_east_mm", "control.east"}, {"residual_up_mm", "control.up"}};
  for (const auto& [column, name] : parts) {
    Curve c{.name = t(name), .style = CurveStyle::points};
    for (std::size_t i = 0; i < r.landmarks.rows.size(); ++i) {
      c.x.push_back(static_cast<double>(i + 1));
      c.y.push_back(r.landmarks.number(i, column));
    }
    f.curves.push_back(std::move(c));
  }
  return f;
}

}  // namespace

void add_exceedances(Pages& pages, const SurveyReport& r, const Texts& t) {
  pages.begin("exceedances", t("exceedances.title"));
  Table table{.id = "exceedances",
              .notes = {t("exceedances.note"), r.limits + ": " + r.limits_source},
              .empty = t("exceedances.none"),
              .row_height = 5.6};
  table.columns = {{t("exceedances.level"), Anchor::start},
                   {t("table.quantity"), Anchor::start},
                   {t("exceedances.peak")},
                   {t("exceedances.start")},
                   {t("exceedances.end")},
                   {with_unit(t, "exceedances.length", "m")},
                   {t("exceedances.value")},
                   {"\xCF\x83"},
                   {t("exceedances.limit")},
                   {t("table.unit"), Anchor::start},
                   {t("exceedances.probability")},
                   {with_unit(t, "table.easting", "m")},
                   {with_unit(t, "table.northing", "m")},
                   {t("exceedances.done"), Anchor::start, true, 1.0}};
  const int levels = static_cast<int>(r.levels.size());
  const RawTable& x = r.exceedances;
  for (std::size_t i = 0; i < x.rows.size(); ++i) {
    const std::string& level = x.at(i, "level");
    table.rows.push_back({{t.phrase(level), level_colour(severity_of(r, level), levels), true},
                          {t.quantity(x.at(i, "column"))},
                          {place(x, i, "peak_m"), colours::ink, true},
                          {place(x, i, "start_m")},
                          {place(x, i, "end_m")},
                          {x.at(i, "length_m")},
                          {x.at(i, "value"), colours::ink, true},
                          {x.at(i, "sigma")},
                          {x.at(i, "limit")},
                          {t.phrase(x.at(i, "unit"))},
                          {percent(x, i, "probability_over")},
                          {x.at(i, "easting_m")},
                          {x.at(i, "northing_m")},
                          {""}});
  }
  pages.add(table);
}

void add_sections(Pages& pages, const SurveyReport& r, const Texts& t) {
  Box box = pages.begin("sections", t("sections.title"));
  const RawTable& s = r.sections;
  double top = 0.0;
  if (s.rows.size() > 1) {
    Figure f{
        .title = t("sections.figure"), .x = {.label = t("sections.distance")}, .y = {.label = t("sections.sigma_mm")}};
    const bool tqi = std::isfinite(s.number(0, "tqi_mm"));
    for (const std::string& column : s.header) {
      const bool band = column.starts_with("sigma_level_") || column.starts_with("sigma_alignment_");
      const bool wanted = tqi ? column == "tqi_mm" : band && column.find("_d1_") != std::string::npos;
      if (!wanted) continue;
      Curve c{.name = tqi ? std::string("TQI") : t.quantity(column.substr(6, column.size() - 9)),
              .style = tqi ? CurveStyle::bars : CurveStyle::line};
      for (std::size_t i = 0; i < s.rows.size(); ++i) {
        c.x.push_back(0.5 * (s.number(i, "start_distance_m") + s.number(i, "end_distance_m")));
        c.y.push_back(s.number(i, column));
      }
      f.curves.push_back(std::move(c));
    }
    if (tqi && r.tqi_limit_mm > 0.0) {
      f.curves.push_back({.name = t("sections.tqi_limit"),
                          .x = {s.number(0, "start_distance_m"), s.number(s.rows.size() - 1, "end_distance_m")},
                          .y = {r.tqi_limit_mm, r.tqi_limit_mm},
                          .style = CurveStyle::dashed,
                          .colour = 1});
    }
    draw(pages.page(), {box.x, box.y, box.width, 62.0}, f);
    top = box.y + 65.0;
  }
  Table table{.id = "sections", .notes = {t("sections.note")}, .empty = t("sections.none")};
  table.columns = {{t("sections.start")}, {t("sections.end")}};
  std::vector<std::string> columns;
  for (const std::string& column : s.header) {
    if (column == "tqi_mm") columns.push_back(column), table.columns.push_back({"TQI, mm"});
    if (column == "cosd_mm") columns.push_back(column), table.columns.push_back({"CoSD, mm"});
    if (!column.starts_with("sigma_")) continue;
    columns.push_back(column);
    const bool ratio = column.ends_with("_mm_per_m");
    const std::string name = column.substr(6, column.size() - 6 - (ratio ? 9 : 3));
    table.columns.push_back({"\xCF\x83 " + t.quantity(name) + ", " + (ratio ? "mm/m" : "mm")});
  }
  // What no section has takes no room.
  for (std::size_t k = columns.size(); k-- > 0;) {
    bool any = false;
    for (std::size_t i = 0; i < s.rows.size(); ++i) any |= !s.at(i, columns[k]).empty();
    if (any) continue;
    columns.erase(columns.begin() + static_cast<std::ptrdiff_t>(k));
    table.columns.erase(table.columns.begin() + static_cast<std::ptrdiff_t>(k) + 2);
  }
  bool classes = false, over = false;
  for (std::size_t i = 0; i < s.rows.size(); ++i) {
    classes |= !s.at(i, "classes").empty();
    over |= !s.at(i, "over").empty();
  }
  if (classes) table.columns.push_back({t("sections.classes"), Anchor::start, true, 1.2});
  if (over) table.columns.push_back({t("sections.over"), Anchor::start, true, 0.8});
  for (std::size_t i = 0; i < s.rows.size(); ++i) {
    auto& row = table.rows.emplace_back();
    row.push_back({place_text(s.number(i, "start_m"), 2)});
    row.push_back({place_text(s.number(i, "end_m"), 2)});
    const bool bad = !s.at(i, "over").empty();
    for (const std::string& column : columns) {
      row.push_back({s.at(i, column), bad && column == "tqi_mm" ? 0xb3261eu : 0x1b1f24u, column == "tqi_mm"});
    }
    if (classes) row.push_back({s.at(i, "classes")});
    if (over) row.push_back({s.at(i, "over"), colours::bad});
  }
  pages.add(table, top);
}

void add_curves(Pages& pages, const SurveyReport& r, const Texts& t) {
  pages.begin("curves", t("curves.title"));
  const RawTable& e = r.elements;
  Table plan{.id = "curves", .title = t("curves.plan"), .notes = {t("curves.note")}, .empty = t("curves.none")};
  plan.columns = {{t("table.number")},
                  {t("curves.from")},
                  {t("curves.to")},
                  {with_unit(t, "curves.length", "m")},
                  {t("curves.element"), Anchor::start},
                  {t("curves.hand"), Anchor::start},
                  {with_unit(t, "curves.radius_start", "m")},
                  {with_unit(t, "curves.radius_end", "m")},
                  {with_unit(t, "curves.cant_start", "mm")},
                  {with_unit(t, "curves.cant_end", "mm")},
                  {with_unit(t, "curves.measured_radius", "m")},
                  {with_unit(t, "curves.measured_cant", "mm")},
                  {with_unit(t, "table.easting", "m")},
                  {with_unit(t, "table.northing", "m")}};
  Table profile{.id = "gradients", .title = t("curves.profile"), .empty = t("curves.none")};
  profile.columns = {{t("table.number")},
                     {t("curves.from")},
                     {t("curves.to")},
                     {with_unit(t, "curves.length", "m")},
                     {t("curves.element"), Anchor::start},
                     {with_unit(t, "curves.radius_start", "m")},
                     {with_unit(t, "curves.gradient_start", "permille")},
                     {with_unit(t, "curves.gradient_end", "permille")},
                     {with_unit(t, "curves.height", "m")}};
  for (std::size_t i = 0; i < e.rows.size(); ++i) {
    const double from = e.number(i, "start_distance_m"), to = from + e.number(i, "length_m");
    // Elements that the survey did not reach stay out.
    if (to < r.distance.front() || from > r.distance.back()) continue;
    const bool flat = e.at(i, "part") == "horizontal";
    auto& rows = flat ? plan.rows : profile.rows;
    std::vector<Cell> row{{fmt::format("{}", rows.size() + 1)},
                          {place(e, i, "start_m")},
                          {place(e, i, "end_m")},
                          {e.at(i, "length_m")},
                          {t.phrase(e.at(i, "shape"))}};
    if (!flat) {
      for (const char* c : {"radius_start_m", "gradient_start_permille", "gradient_end_permille", "height_m"}) {
        row.push_back({e.at(i, c)});
      }
      rows.push_back(std::move(row));
      continue;
    }
    const double start = e.number(i, "radius_start_m"), end = e.number(i, "radius_end_m");
    const double bend = std::isfinite(start) ? start : end;
    row.push_back({!std::isfinite(bend) ? "" : t(bend > 0.0 ? "curves.right" : "curves.left")});
    for (const char* c : {"radius_start_m", "radius_end_m", "cant_start_mm", "cant_end_mm"})
      row.push_back({e.at(i, c)});
    const bool arc = e.at(i, "shape") == "arc";
    const double margin = std::min(10.0, 0.2 * (to - from));
    const double curvature = arc ? mean_between(r, "curvature", from + margin, to - margin) : std::nan("");
    row.push_back({radius_text(1e3 / curvature)});
    row.push_back({arc ? decimal(mean_between(r, "cross_level", from + margin, to - margin), 2) : ""});
    row.push_back({e.at(i, "easting_m")});
    row.push_back({e.at(i, "northing_m")});
    rows.push_back(std::move(row));
  }
  const double y = pages.add(plan);
  pages.add(profile, y + 6.0);
}

void add_control(Pages& pages, const SurveyReport& r, const Texts& t) {
  Box box = pages.begin("control", t("control.title"));
  double top = 0.0;
  if (r.landmarks.rows.size() > 1) {
    draw(pages.page(), {box.x, box.y, box.width, 58.0}, residual_figure(r, t));
    top = box.y + 61.0;
  }
  if (!r.landmarks.rows.empty()) {
    Table table{.id = "control", .title = t("control.points"), .notes = {t("control.note")}, .empty = ""};
    table.columns = {{t("table.number")},
                     {t("control.name"), Anchor::start},
                     {t("control.place")},
                     {t("control.time")},
                     {t("control.used"), Anchor::start},
                     {t("control.north") + ", mm"},
                     {t("control.east") + ", mm"},
                     {t("control.up") + ", mm"},
                     {t("control.sigma_north") + ", mm"},
                     {t("control.sigma_east") + ", mm"},
                     {t("control.sigma_up") + ", mm"},
                     {t("control.trajectory_north") + ", mm"},
                     {t("control.trajectory_east") + ", mm"},
                     {t("control.trajectory_up") + ", mm"}};
    const RawTable& l = r.landmarks;
    for (std::size_t i = 0; i < l.rows.size(); ++i) {
      const bool used = l.at(i, "used") != "0";
      std::vector<Cell> row{{fmt::format("{}", i + 1)},
                            {l.at(i, "name")},
                            {place(l, i, "mileage_m")},
                            {l.at(i, "time_s")},
                            {t(used ? "control.yes" : "control.rejected"), used ? 0x1b1f24u : 0xb3261eu, !used}};
      for (const char* what : {"residual", "sigma_landmark", "sigma_trajectory"}) {
        for (const char* axis : {"north", "east", "up"}) row.push_back({l.at(i, fmt::format("{}_{}_mm", what, axis))});
      }
      table.rows.push_back(std::move(row));
    }
    top = pages.add(table, top) + 6.0;
  } else {
    pages.page().text({box.x, box.y + 3.5}, t("control.none"), {.size = 2.8, .colour = colours::muted});
    top = box.y + 9.0;
  }
  Table sensors{.id = "sensors",
                .title = t("control.sensors"),
                .notes = {t("control.sensors_note")},
                .empty = t("control.no_sensors")};
  sensors.columns = {{t("record.sensor"), Anchor::start},
                     {t("control.used_count")},
                     {t("control.rejected_count")},
                     {t("control.nis")},
                     {t("control.lower")},
                     {t("control.upper")}};
  sensors.rows = cells_of(r.innovations, {"sensor", "used", "rejected", "mean_nis_per_row", "lower", "upper"});
  pages.add(sensors, top);
}

void add_adjustment(Pages& pages, const SurveyReport& r, const Texts& t) {
  pages.begin("adjustment", t("adjustment.title"));
  Table table{.id = "adjustment", .notes = r.adjustment_notes, .empty = ""};
  table.notes.insert(table.notes.begin(), t("adjustment.note"));
  const std::size_t n = r.adjustment.header.size();
  table.blocks = n <= 3 ? 5 : n <= 5 ? 4 : n <= 8 ? 2 : 1;
  for (const std::string& column : r.adjustment.header) {
    table.columns.push_back({t.quantity(column), column == "reference_rail" ? Anchor::start : Anchor::end});
  }
  // Ten kilometres have 4000 rows of 2.5 m: thirty pages that nobody leafs through.
  const std::size_t every = r.adjustment.rows.size() / 2500 + 1;
  if (every > 1) table.notes.push_back(fmt::format(fmt::runtime(t("adjustment.thinned")), every));
  for (std::size_t i = 0; i < r.adjustment.rows.size(); i += every) {
    auto& row = table.rows.emplace_back();
    for (std::size_t k = 0; k < r.adjustment.rows[i].size(); ++k) {
      const bool mileage = k < n && r.adjustment.header[k] == "mileage_m";
      row.push_back({mileage ? place(r.adjustment, i, "mileage_m") : t.phrase(r.adjustment.rows[i][k])});
    }
  }
  pages.add(table);
}

}  // namespace versine::report
