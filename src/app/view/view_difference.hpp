// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "view_survey_parts.hpp"

namespace versine::app {

/// Two runs over one track, one minus the other: strips of the tab "difference", and the other run's own values on this
/// run's places ("compare:" and the column), to be drawn beside them.
struct ViewDifference {
  std::string title;  ///< of the other run
  std::vector<ViewStrip> strips;
  std::vector<std::pair<std::string, ViewSeries>> series;
};

/// The runs' mileages are aligned piece by piece by correlation (track::find_shifts) before they are subtracted.
[[nodiscard]] Expected<ViewDifference> difference_of(const SurveyFiles& files, const io::GeometryTable& table,
                                                     const std::vector<ViewStrip>& strips,
                                                     const std::filesystem::path& other);

}  // namespace versine::app
