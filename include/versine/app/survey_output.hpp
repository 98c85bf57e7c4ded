// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/app/survey.hpp"
#include "versine/io/result_folder.hpp"

namespace versine::app {

/// Writes every file of a survey's result and commits the folder; `run` is what has begun.
[[nodiscard]] Expected<SurveyRun> write_survey(const SurveyConfig& config, SurveyResult& result, io::Run run,
                                               io::ResultFolder& folder, Progress& progress);

}  // namespace versine::app
