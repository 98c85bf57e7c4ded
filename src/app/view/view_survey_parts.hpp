// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "versine/app/view_series.hpp"
#include "versine/core/error.hpp"
#include "versine/io/geometry_table.hpp"
#include "view_strips.hpp"

/// Parts of the survey screen's JSON, each from its files.
namespace versine::app {

/// What every part needs of a result.
struct SurveyFiles {
  std::filesystem::path folder;
  nlohmann::ordered_json run;       ///< run.json
  nlohmann::ordered_json results;   ///< of the track geometry: points, levels, limits
  nlohmann::ordered_json settings;  ///< the job's [geometry]
};

/// The grid of the track geometry and what belongs to each of its points.
struct SurveyGrid {
  ViewSeries::Places x;  ///< continuous distance, m
  std::vector<double> mileage, time_s, flags, easting, northing;
};

/// Limits by column, mildest first, each with its place in the order of severity ("AL", "IL" or "IAL" for the page).
[[nodiscard]] std::map<std::string, nlohmann::ordered_json> limits_by_column(const SurveyFiles& files);
[[nodiscard]] nlohmann::ordered_json verdict_of(const SurveyFiles& files);
[[nodiscard]] Expected<nlohmann::ordered_json> exceedances_of(const SurveyFiles& files,
                                                              const std::vector<ViewStrip>& strips);
[[nodiscard]] nlohmann::ordered_json chainage_of(const SurveyFiles& files, const SurveyGrid& grid);
[[nodiscard]] nlohmann::ordered_json plan_of(const std::string& crs, const std::vector<double>& x,
                                             const std::vector<double>& easting, const std::vector<double>& northing);
[[nodiscard]] Expected<nlohmann::ordered_json> control_points_of(const SurveyFiles& files, const SurveyGrid& grid);

/// Slews and lifts of adjustment.csv on the grid's own places; empty where there are none.
struct AdjustmentSeries {
  ViewStrip strip;
  ViewSeries series;
};
[[nodiscard]] Expected<std::vector<AdjustmentSeries>> adjustment_of(const SurveyFiles& files, const SurveyGrid& grid);

/// The JSON of /api/result around a screen's own part: title, version, warnings, findings, rejections.
[[nodiscard]] std::string view_frame(const char* kind, const SurveyFiles& files, const std::string& crs,
                                     const std::string& subtitle, nlohmann::ordered_json verdict,
                                     nlohmann::ordered_json survey);
/// report.html of the folder, read when it is asked for.
[[nodiscard]] std::function<std::optional<std::string>()> report_of(const std::filesystem::path& folder);

/// NaN and infinities have no JSON: null.
[[nodiscard]] nlohmann::ordered_json number_or_null(double value);

}  // namespace versine::app
