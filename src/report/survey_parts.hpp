// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/report/strip.hpp"
#include "versine/report/survey_report.hpp"

/// The chapters of the survey's report; each adds its own pages.
namespace versine::report {

void add_cover(Pages& pages, const SurveyReport& r, const Texts& t);
void add_overview(Pages& pages, const SurveyReport& r, const Texts& t);
void add_trajectory(Pages& pages, const SurveyReport& r, const Texts& t);
void add_exceedances(Pages& pages, const SurveyReport& r, const Texts& t);
void add_sections(Pages& pages, const SurveyReport& r, const Texts& t);
void add_curves(Pages& pages, const SurveyReport& r, const Texts& t);
void add_control(Pages& pages, const SurveyReport& r, const Texts& t);
void add_strip_pages(Pages& pages, const SurveyReport& r, const Texts& t);
void add_adjustment(Pages& pages, const SurveyReport& r, const Texts& t);

/// Strips of the quantities that a surveyor looks at first, with one scale for the whole survey.
[[nodiscard]] std::vector<Strip> survey_strips(const SurveyReport& r, const Texts& t);
[[nodiscard]] StripAxis survey_axis(const SurveyReport& r, double from, double to, double span);
/// Map of the axis with its exceedances and kilometre marks.
[[nodiscard]] MapView survey_map(const SurveyReport& r);
/// "12+345" or, with metres' fractions, "12+345.25".
[[nodiscard]] std::string place_text(double posted, int decimals = 0);
/// Index of a level, 0 the mildest.
[[nodiscard]] int severity_of(const SurveyReport& r, const std::string& level);

}  // namespace versine::report
