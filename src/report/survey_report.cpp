// SPDX-License-Identifier: Apache-2.0
#include "versine/report/survey_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "survey_parts.hpp"

namespace versine::report {

const Quantity* SurveyReport::find(const std::string& column) const {
  const auto it =
      std::find_if(quantities.begin(), quantities.end(), [&](const Quantity& q) { return q.column == column; });
  return it == quantities.end() ? nullptr : &*it;
}

double SurveyReport::posted_at(double s) const {
  if (distance.empty()) return s;
  const auto it = std::upper_bound(distance.begin(), distance.end(), s);
  const auto i = it == distance.begin() ? std::size_t{0} : static_cast<std::size_t>(it - distance.begin()) - 1;
  // The grid point's own number goes on to the next one; which way, its neighbour behind or before tells.
  const std::size_t k =
      i + 1 < distance.size() && std::abs(posted[i + 1] - posted[i]) <= 1.01 * (distance[i + 1] - distance[i]) ? i + 1
                                                                                                               : i;
  const double sense = k > 0 && posted[k] < posted[k - 1] ? -1.0 : 1.0;
  return posted[i] + sense * (s - distance[i]);
}

int severity_of(const SurveyReport& r, const std::string& level) {
  const auto it = std::find(r.levels.begin(), r.levels.end(), level);
  return it == r.levels.end() ? 0 : static_cast<int>(it - r.levels.begin());
}

Verdict verdict(const SurveyReport& r) {
  if (r.levels.empty()) return Verdict::not_assessed;
  int worst = -1;
  for (std::size_t i = 0; i < r.exceedances.rows.size(); ++i) {
    worst = std::max(worst, severity_of(r, r.exceedances.at(i, "level")));
  }
  if (worst + 1 == static_cast<int>(r.levels.size())) return Verdict::not_accepted;
  bool section_over = false;
  for (std::size_t i = 0; i < r.sections.rows.size(); ++i) section_over |= !r.sections.at(i, "over").empty();
  return worst >= 0 || section_over ? Verdict::with_remarks : Verdict::accepted;
}

std::string place_text(double posted, int decimals) {
  if (!std::isfinite(posted)) return "";
  const double unit = std::pow(10.0, decimals), rounded = std::round(std::abs(posted) * unit) / unit;
  const double km = std::floor(rounded / 1000.0);
  return fmt::format("{}{:.0f}+{:0{}.{}f}", posted < 0.0 && rounded > 0.0 ? "-" : "", km, rounded - 1000.0 * km,
                     decimals > 0 ? 4 + decimals : 3, decimals);
}

Document survey_document(const SurveyReport& r, const Texts& t) {
  Document d{.title = t("cover.survey"), .subject = subject_of(r.facts), .created = r.facts.started};
  d.language = t.language();
  d.footer = r.distance.empty() ? t("footer.trajectory") : t("footer.survey");
  d.source = fmt::format("{}: {} \xC2\xB7 Versine {} \xC2\xB7 {}", t("footer.source"), r.facts.folder, r.facts.version,
                         r.facts.started);
  if (!r.limits.empty()) {
    d.source += fmt::format(" \xC2\xB7 {}: {}, {:g} km/h", t("footer.limits"), r.limits, r.speed_kmh);
  }
  Pages pages(d);
  add_cover(pages, r, t);
  if (r.distance.empty()) {
    add_trajectory(pages, r, t);
  } else {
    add_overview(pages, r, t);
    if (!r.levels.empty()) {
      add_exceedances(pages, r, t);
      add_sections(pages, r, t);
    }
    if (!r.elements.rows.empty()) add_curves(pages, r, t);
  }
  add_control(pages, r, t);
  if (!r.distance.empty()) add_strip_pages(pages, r, t);
  if (!r.adjustment.rows.empty()) add_adjustment(pages, r, t);
  add_record(pages, r.facts, t);
  add_inputs(pages, r.facts, t);
  finish(d, t);
  return d;
}

}  // namespace versine::report
