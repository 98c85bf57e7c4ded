// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "view_survey_parts.hpp"

namespace versine::app {

/// "Can I pack up?": what must be right before the possession ends, one line each with `name`, `good` and `text`.
/// `distance` is the way travelled at each place `x` of the view, m (track distance over itself); `flags` of the track
/// geometry may be empty. Works on what a running job has so far, too.
[[nodiscard]] nlohmann::ordered_json pack_up_of(const SurveyFiles& files, const SurveyGrid& grid,
                                                const std::vector<double>& distance,
                                                const nlohmann::ordered_json& control,
                                                const nlohmann::ordered_json& exceedances);

}  // namespace versine::app
