// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/app/survey.hpp"
#include "versine/io/result_folder.hpp"

namespace versine::app {

/// Writes every file of a survey's result and commits the folder; `run` is what has begun.
[[nodiscard]] Expected<SurveyRun> write_survey(const SurveyConfig& config, SurveyResult& result, io::Run run,
                                               io::ResultFolder& folder, Progress& progress);

/// A JSON object: how often the vehicle stood (`count`), for how long (`total_s`, `longest_s`), and how long before it
/// first moved (`first_s`).
[[nodiscard]] std::string standstills_json(std::span<const inertial::Interval> standstills, Time begin);

}  // namespace versine::app
