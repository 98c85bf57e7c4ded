// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "colours.hpp"
#include "survey_parts.hpp"

namespace versine::report {

namespace {

/// Columns of the strips, from above to below: the first that is there of each list; '*' stands for any end.
const std::vector<std::vector<std::string>> wanted{
    {"gauge_deviation", "gauge"},
    {"cross_level_deviation", "cross_level"},
    {"twist_*"},
    {"level_left_*", "versine_vertical_left_*"},
    {"level_right_*", "versine_vertical_right_*"},
    {"alignment_left_*", "versine_lateral_left_*"},
    {"alignment_right_*", "versine_lateral_right_*"},
    {"deviation_lateral_axis"},
    {"deviation_vertical_axis", "height_axis"},
};

const Quantity* first_of(const SurveyReport& r, const std::vector<std::string>& patterns) {
  for (const std::string& pattern : patterns) {
    const bool any = pattern.ends_with('*');
    const std::string head = any ? pattern.substr(0, pattern.size() - 1) : pattern;
    for (const Quantity& q : r.quantities) {
      if (any ? q.column.starts_with(head) : q.column == head) return &q;
    }
  }
  return nullptr;
}

std::string limits_text(const SurveyReport& r, const std::string& column) {
  std::string text;
  for (const SurveyLimit& l : r.applied) {
    if (l.column != column) continue;
    text += fmt::format("{}{} {:.3g}/{:+.3g}", text.empty() ? "" : ", ", l.level, l.low, l.high);
  }
  return text;
}

Strip strip_of(const SurveyReport& r, const Texts& t, const Quantity& q) {
  const int levels = static_cast<int>(r.levels.size());
  Strip s{.name = t.quantity(q.column), .detail = t.phrase(q.unit)};
  s.curves.push_back({q.value, q.sigma});
  for (const SurveyLimit& l : r.applied) {
    if (l.column != q.column) continue;
    s.limits.push_back({l.low, l.severity, levels, l.level});
    s.limits.push_back({l.high, l.severity, levels, l.level});
  }
  if (const std::string text = limits_text(r, q.column); !text.empty()) s.detail += "; " + text;
  for (std::size_t i = 0; i < r.exceedances.rows.size(); ++i) {
    if (r.exceedances.at(i, "column") != q.column) continue;
    s.marks.push_back({r.exceedances.number(i, "peak_distance_m"), r.exceedances.number(i, "start_distance_m"),
                       r.exceedances.number(i, "end_distance_m"), severity_of(r, r.exceedances.at(i, "level")),
                       levels});
  }
  s.decimals = q.unit == "mm/m" ? 2 : q.unit == "m" ? 3 : 1;
  if (q.column.starts_with("height")) fit_to_data(s);
  return s;
}

}  // namespace

std::vector<Strip> survey_strips(const SurveyReport& r, const Texts& t) {
  std::vector<Strip> out;
  if (const Quantity* k = r.find("curvature")) {
    Strip s{.name = t("strips.curvature"), .detail = t("strips.curvature_detail")};
    s.curves.push_back({k->value, {}, colours::ink, Dash::solid});
    s.decimals = 2;
    out.push_back(std::move(s));
  }
  for (const auto& patterns : wanted) {
    if (const Quantity* q = first_of(r, patterns)) out.push_back(strip_of(r, t, *q));
  }
  for (Strip& s : out) fit_scale(s);
  return out;
}

StripAxis survey_axis(const SurveyReport& r, double from, double to, double span) {
  StripAxis axis{.x = r.distance, .from = from, .to = to, .span = span};
  axis.posted = [&r](double s) { return r.posted_at(s); };
  axis.label = [&r](double s) { return place_text(r.posted_at(s)); };
  for (std::size_t i = 1; i < r.distance.size(); ++i) {
    const double step = r.distance[i] - r.distance[i - 1], posted = r.posted[i] - r.posted[i - 1];
    if (std::abs(std::abs(posted) - step) < 0.02) continue;
    const double before = r.posted_at(r.distance[i] - 1e-6), jump = r.posted[i] - before;
    axis.jumps.push_back(
        {r.distance[i], fmt::format("{} = {}, {:+.2f} m", place_text(before, 2), place_text(r.posted[i], 2), jump)});
  }
  return axis;
}

MapView survey_map(const SurveyReport& r) {
  MapView view{.caption = r.crs};
  view.lines.push_back({r.axis, {colours::accent, 0.6, Dash::solid}});
  if (r.axis.empty()) return view;
  if (!r.distance.empty()) {
    const double length = r.distance.back() - r.distance.front();
    const double every = length > 30000.0 ? 10000.0 : length > 15000.0 ? 5000.0 : length > 3000.0 ? 1000.0 : 200.0;
    double last = std::nan("");
    for (std::size_t i = 0; i < r.distance.size(); ++i) {
      const double k = std::floor(r.posted[i] / every + 1e-6);
      const bool first = !std::isfinite(last);
      if ((first || k != last) && std::isfinite(r.axis[i].x)) {
        if (!first) view.marks.push_back({r.axis[i], place_text(std::round(r.posted[i] / every) * every)});
        last = k;
      }
    }
  }
  const int levels = static_cast<int>(r.levels.size());
  for (std::size_t i = 0; i < r.exceedances.rows.size(); ++i) {
    const double e = r.exceedances.number(i, "easting_m"), n = r.exceedances.number(i, "northing_m");
    if (std::isfinite(e) && std::isfinite(n)) {
      view.marks.push_back({{e, n}, "", severity_of(r, r.exceedances.at(i, "level")), levels});
    }
  }
  return view;
}

void add_strip_pages(Pages& pages, const SurveyReport& r, const Texts& t) {
  constexpr double per_page = 500.0;  // m
  auto strips = survey_strips(r, t);
  if (strips.empty() || r.distance.size() < 2) return;
  pages.begin("strips", t("strips.title"));
  bool first = true;
  const double start = std::floor(r.distance.front() / per_page + 1e-9) * per_page;
  for (double s = start; s < r.distance.back() - 1e-6; s += per_page) {
    const double from = std::max(s, r.distance.front()), to = std::min(s + per_page, r.distance.back());
    Box box = first ? content_box(pages.page()) : pages.next();
    first = false;
    pages.page().text({box.x, box.y + 2.6},
                      fmt::format("km {} \xE2\x80\x93 {}   {}", place_text(r.posted_at(from)),
                                  place_text(r.posted_at(to - 1e-6)), t("strips.note")),
                      {.size = 2.5, .colour = colours::muted});
    box.y += 4.5;
    box.height -= 4.5;
    draw_strips(pages.page(), box, strips, survey_axis(r, s, to, per_page));
  }
}

}  // namespace versine::report
