// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "colours.hpp"
#include "survey_parts.hpp"

namespace versine::report {

namespace {

using colours::ink, colours::muted;

std::string levels_counted(const SurveyReport& r, const Texts& t) {
  std::map<std::string, int> counts;
  for (std::size_t i = 0; i < r.exceedances.rows.size(); ++i) ++counts[r.exceedances.at(i, "level")];
  std::string text;
  for (auto level = r.levels.rbegin(); level != r.levels.rend(); ++level) {
    if (counts[*level] > 0) text += fmt::format("{}{} {}", text.empty() ? "" : "   ", counts[*level], t.phrase(*level));
  }
  return text;
}

/// The verdict in one look: a colour, a sign, a word.
void draw_verdict(Drawing& d, const Box& box, const SurveyReport& r, const Texts& t) {
  struct Look {
    const char* key;
    std::uint32_t colour, fill;
  };
  const Look look = [&]() -> Look {
    switch (verdict(r)) {
      case Verdict::not_assessed:
        return {"verdict.not_assessed", colours::muted, 0xf3f5f8};
      case Verdict::accepted:
        return {"verdict.accepted", colours::good, colours::good_fill};
      case Verdict::with_remarks:
        return {"verdict.with_remarks", colours::doubt, colours::doubt_fill};
      case Verdict::not_accepted:
        return {"verdict.not_accepted", colours::bad, colours::bad_fill};
    }
    return {"verdict.not_assessed", colours::muted, 0xf3f5f8};
  }();
  d.rectangle(box, Fill{look.fill}, Pen{look.colour, 0.5, Dash::solid});
  d.rectangle({box.x, box.y, 3.0, box.height}, Fill{look.colour});
  d.text({box.x + 7.0, box.y + 8.2}, t(look.key), {.size = 5.6, .bold = true, .colour = look.colour});
  std::string detail = t(verdict(r) == Verdict::not_assessed ? "verdict.no_limits" : "verdict.no_exceedance");
  if (!r.exceedances.rows.empty()) detail = levels_counted(r, t);
  std::size_t over = 0;
  for (std::size_t i = 0; i < r.sections.rows.size(); ++i) over += r.sections.at(i, "over").empty() ? 0 : 1;
  if (over > 0) detail += "   " + fmt::format(fmt::runtime(t("verdict.sections_over")), over);
  d.text({box.x + 7.0, box.y + 13.8}, fitted(detail, box.width - 10.0, 3.0), {.size = 3.0, .colour = ink});
  if (!r.unchecked.empty()) {
    std::string list;
    for (const std::string& u : r.unchecked) list += (list.empty() ? "" : ", ") + u;
    d.text({box.x + 7.0, box.y + 18.0}, fitted(t("verdict.unchecked") + ": " + list, box.width - 10.0, 2.4),
           {.size = 2.4, .colour = muted});
  }
}

std::vector<std::pair<std::string, std::string>> who_and_where(const SurveyReport& r, const Texts& t) {
  const Cover& c = r.facts.cover;
  std::vector<std::pair<std::string, std::string>> rows{{t("cover.line"), c.line.empty() ? r.facts.title : c.line},
                                                        {t("cover.track"), c.track}};
  if (!r.distance.empty()) {
    rows.emplace_back(t("cover.stretch"),
                      fmt::format("km {} \xE2\x80\x93 {}  ({:.2f} m)", place_text(r.posted.front(), 2),
                                  place_text(r.posted.back(), 2), r.distance.back() - r.distance.front()));
  }
  rows.insert(rows.end(), {{t("cover.direction"), c.direction},
                           {t("cover.date"), c.date},
                           {t("cover.shift"), c.shift},
                           {t("cover.operator"), c.operated_by},
                           {t("cover.client"), c.client},
                           {t("cover.trolley"), c.trolley},
                           {t("cover.calibrated"), c.calibrated}});
  if (!c.remarks.empty()) rows.emplace_back(t("cover.remarks"), c.remarks);
  return rows;
}

std::vector<std::pair<std::string, std::string>> how(const SurveyReport& r, const Texts& t) {
  std::vector<std::pair<std::string, std::string>> rows{{t("cover.crs"), r.crs},
                                                        {t("cover.height_datum"), t.phrase(r.height_datum)},
                                                        {t("cover.method"), t.phrase(r.origin)}};
  if (!r.limits.empty()) {
    rows.emplace_back(t("cover.limits"), fmt::format("{}, {:g} km/h", r.limits, r.speed_kmh));
    rows.emplace_back(t("cover.limits_source"), r.limits_source);
  }
  for (const auto& [key, value] : r.key_numbers) rows.emplace_back(t(key), value);
  rows.emplace_back(t("cover.software"),
                    fmt::format("Versine {}, versine {}, {}", r.facts.version, r.facts.command, r.facts.started));
  return rows;
}

void draw_signatures(Drawing& d, const Box& box, const Texts& t) {
  const char* keys[] = {"cover.signed_surveyor", "cover.signed_checked", "cover.signed_client"};
  const double width = (box.width - 20.0) / 3.0;
  for (int k = 0; k < 3; ++k) {
    const double x = box.x + k * (width + 10.0);
    d.line({x, box.bottom() - 5.0}, {x + width, box.bottom() - 5.0}, {ink, 0.2, Dash::solid});
    d.text({x, box.bottom() - 1.5}, t(keys[k]), {.size = 2.4, .colour = muted});
  }
}

void draw_heading(Drawing& d, Point at, const std::string& text) {
  d.text(at, text, {.size = 3.0, .bold = true, .colour = colours::accent});
}

struct Summary {
  std::size_t values = 0;
  double rms = 0.0, p95 = 0.0, worst = 0.0, worst_at = 0.0, sigma = 0.0;
};

Summary summarise(const Quantity& q, const std::vector<double>& distance) {
  Summary s;
  std::vector<double> size;
  double sum = 0.0, sigma = 0.0;
  std::size_t sigmas = 0;
  for (std::size_t i = 0; i < q.value.size(); ++i) {
    const double v = q.value[i];
    if (!std::isfinite(v)) continue;
    size.push_back(std::abs(v));
    sum += v * v;
    if (size.size() == 1 || std::abs(v) > std::abs(s.worst)) {
      s.worst = v;
      s.worst_at = distance[i];
    }
    if (i < q.sigma.size() && std::isfinite(q.sigma[i])) {
      sigma += q.sigma[i];
      ++sigmas;
    }
  }
  s.values = size.size();
  if (size.empty()) return s;
  s.rms = std::sqrt(sum / static_cast<double>(size.size()));
  const auto at = size.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(size.size() - 1));
  std::nth_element(size.begin(), at, size.end());
  s.p95 = *at;
  s.sigma = sigmas > 0 ? sigma / static_cast<double>(sigmas) : std::nan("");
  return s;
}

Table summary_table(const SurveyReport& r, const Texts& t) {
  Table table{.id = "summary", .title = t("overview.summary"), .notes = {t("overview.summary_note")}};
  table.columns = {{t("table.quantity"), Anchor::start},
                   {t("table.unit"), Anchor::start},
                   {t("overview.rms")},
                   {t("overview.p95")},
                   {t("overview.worst")},
                   {t("overview.at")},
                   {t("overview.sigma")}};
  for (const Quantity& q : r.quantities) {
    const bool shown = q.column.starts_with("gauge_dev") || q.column.starts_with("cross_level") ||
                       q.column.starts_with("twist") || q.column.starts_with("level_") ||
                       q.column.starts_with("alignment_") || q.column.starts_with("deviation_");
    const Summary s = shown ? summarise(q, r.distance) : Summary{};
    if (s.values == 0) continue;
    const int digits = q.unit == "mm/m" ? 3 : 2;
    table.rows.push_back({{t.quantity(q.column)},
                          {t.phrase(q.unit)},
                          {decimal(s.rms, digits)},
                          {decimal(s.p95, digits)},
                          {decimal(s.worst, digits)},
                          {place_text(r.posted_at(s.worst_at), 1)},
                          {decimal(s.sigma, digits)}});
  }
  return table;
}

}  // namespace

void add_cover(Pages& pages, const SurveyReport& r, const Texts& t) {
  const Box box = pages.begin("cover", t("cover.title"));
  Drawing& d = pages.page();
  d.text({box.x, box.y + 8.0}, t(r.distance.empty() ? "cover.positions" : "cover.survey"), {.size = 7.0, .bold = true});
  d.text({box.x, box.y + 15.0}, fitted(subject_of(r.facts), 150.0, 4.2), {.size = 4.2, .colour = muted});
  const double right = box.x + 166.0;
  draw_verdict(d, {right, box.y + 1.0, box.right() - right, 20.5}, r, t);
  draw_heading(d, {box.x, box.y + 26.0}, t("cover.who"));
  const double left_end = draw_pairs(d, {box.x, box.y + 28.0, 78.0, 0.0}, who_and_where(r, t), 26.0);
  draw_heading(d, {box.x + 84.0, box.y + 26.0}, t("cover.how"));
  const double right_end = draw_pairs(d, {box.x + 84.0, box.y + 28.0, 78.0, 0.0}, how(r, t), 26.0);
  draw_map(d, {right, box.y + 25.0, box.right() - right, 73.0}, survey_map(r));
  std::vector<std::pair<std::string, std::string>> signs;
  for (const auto& [what, convention] : r.conventions) signs.emplace_back(t.phrase(what), t.phrase(convention));
  signs.emplace_back(t("cover.uncertainty"), t("cover.uncertainty_text"));
  const double low = std::max({left_end, right_end, box.y + 100.0}) + 5.0;
  draw_heading(d, {box.x, low}, t("cover.conventions"));
  const std::size_t half = (signs.size() + 1) / 2;
  draw_pairs(d, {box.x, low + 2.0, 136.0, 0.0}, {signs.begin(), signs.begin() + static_cast<std::ptrdiff_t>(half)},
             40.0, 2.5);
  draw_pairs(d, {box.x + 144.0, low + 2.0, 137.0, 0.0},
             {signs.begin() + static_cast<std::ptrdiff_t>(half), signs.end()}, 40.0, 2.5);
  draw_signatures(d, {box.x, box.bottom() - 16.0, box.width, 15.0}, t);
}

void add_overview(Pages& pages, const SurveyReport& r, const Texts& t) {
  Box box = pages.begin("overview", t("overview.title"));
  const auto strips = survey_strips(r, t);
  const double span = std::max(r.distance.back() - r.distance.front(), 1e-3);
  pages.page().text({box.x, box.y + 2.6}, t("strips.note"), {.size = 2.5, .colour = muted});
  draw_strips(pages.page(), {box.x, box.y + 4.5, box.width, box.height - 4.5}, strips,
              survey_axis(r, r.distance.front(), r.distance.back(), span));
  pages.next();
  pages.add(summary_table(r, t));
}

void add_trajectory(Pages& pages, const SurveyReport& r, const Texts& t) {
  Box box = pages.begin("trajectory", t("trajectory.title"));
  Drawing& d = pages.page();
  d.text({box.x, box.y + 3.5}, t("trajectory.no_geometry"), {.size = 2.8, .colour = muted});
  if (r.time.size() < 2) return;
  std::vector<Strip> strips;
  for (const Quantity& q : r.trajectory) {
    Strip s{.name = t.quantity(q.column), .detail = t.phrase(q.unit), .decimals = q.unit == "m" ? 3 : 2};
    s.curves.push_back({q.value, q.sigma});
    fit_to_data(s);
    strips.push_back(std::move(s));
  }
  StripAxis axis{.x = r.time, .from = r.time.front(), .to = r.time.back(), .span = r.time.back() - r.time.front()};
  axis.posted = [](double s) { return s; };
  axis.label = [](double s) { return fmt::format("{:.0f} s", s); };
  draw_strips(d, {box.x, box.y + 6.0, box.width, box.height - 6.0}, strips, axis);
}

}  // namespace versine::report
