// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "versine/app/control_check.hpp"
#include "versine/app/geometry.hpp"
#include "versine/app/survey_config.hpp"
#include "versine/app/survey_input.hpp"
#include "versine/app/withhold.hpp"
#include "versine/core/progress.hpp"
#include "versine/fusion/aided_ins.hpp"
#include "versine/inertial/earth_rate.hpp"

/// `versine survey`: from a recording to a trajectory with its uncertainty.
namespace versine::app {

struct SurveyResult {
  SurveyInput input;
  fusion::AidedInsResult estimate;
  std::optional<WithheldErrors> withheld;
  std::optional<GeometryResult> geometry;
  std::optional<ControlCheck> control;
  std::vector<std::string> warnings;              ///< of input and estimate, once written
  std::optional<inertial::EarthRate> earth_rate;  ///< from the longest standstill, where the gyros can tell it
  std::vector<std::pair<std::string, double>> timings_s;
};

/// Sees what a survey has so far, stage by stage.
class SurveyWatch : public fusion::RunWatch {
 public:
  virtual void read(const SurveyInput& input) = 0;
  virtual void solved(const fusion::AidedInsResult& estimate) = 0;
};

/// All stages up to the solution: read, check, align, forward pass, smoother. Nothing is written.
[[nodiscard]] Expected<SurveyResult> compute_survey(const SurveyConfig& config, const std::filesystem::path& job,
                                                    Progress& progress, Log& log, SurveyWatch* onlooker = nullptr);

/// Runs a job: computes and writes the result folder. `output` overrides the job's folder when not empty.
struct SurveyRun {
  std::filesystem::path folder;
  std::string summary_json;  ///< as in run.json
  std::string summary_text;  ///< for a person
};
[[nodiscard]] Expected<SurveyRun> run_survey(const std::filesystem::path& job, std::span<const std::string> overrides,
                                             const std::filesystem::path& output, Progress& progress, Log& log);

}  // namespace versine::app
