// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "versine/report/facts.hpp"
#include "versine/report/map.hpp"

/// The report of a survey, or of track geometry made from another trajectory.
namespace versine::report {

/// One quantity along the track, in the units of its file.
struct Quantity {
  std::string column;  ///< "gauge_deviation": what limits and exceedances name
  std::string unit;    ///< "mm"
  std::vector<double> value;
  std::vector<double> sigma;  ///< empty: the file has none
};

struct SurveyLimit {
  std::string column, level;
  int severity = 0;
  double low = 0.0, high = 0.0;  ///< in the column's unit
};

/// Everything that a result folder tells, read; what it does not hold is empty.
struct SurveyReport {
  Facts facts;
  std::string crs, height_datum, origin;
  std::vector<std::pair<std::string, std::string>> conventions;
  std::vector<std::pair<std::string, std::string>> key_numbers;  ///< of the positioning: a text key and its value

  // Along the track; empty without track geometry.
  std::vector<double> distance, posted;  ///< m
  std::vector<Quantity> quantities;
  std::vector<Point> axis;  ///< easting, northing

  // Along the time, of a survey without track geometry.
  std::vector<double> time;  ///< s since the start
  std::vector<Quantity> trajectory;

  // Quality; `levels` is empty when nothing was assessed.
  std::string limits, limits_source;
  double speed_kmh = 0.0;
  double tqi_limit_mm = 0.0;
  std::vector<std::string> levels;
  std::vector<SurveyLimit> applied;
  std::vector<std::string> unchecked;
  RawTable exceedances, sections, elements, landmarks, innovations, adjustment;
  std::vector<std::string> adjustment_notes;

  [[nodiscard]] const Quantity* find(const std::string& column) const;
  /// Posted mileage of a continuous distance.
  [[nodiscard]] double posted_at(double distance) const;
};

enum class Verdict { not_assessed, accepted, with_remarks, not_accepted };
/// Not accepted when the severest level is exceeded, with remarks when any other is.
[[nodiscard]] Verdict verdict(const SurveyReport& report);

[[nodiscard]] Document survey_document(const SurveyReport& report, const Texts& texts);

}  // namespace versine::report
