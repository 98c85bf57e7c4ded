// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/app/view_server.hpp"
#include "view_survey_parts.hpp"

namespace versine::app {

/// A survey without track geometry: height, speed, attitude and sigmas over time, and the plan.
[[nodiscard]] Expected<ViewContent> open_trajectory_view(SurveyFiles files);

}  // namespace versine::app
