// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "versine/app/survey_config.hpp"
#include "versine/core/progress.hpp"
#include "versine/core/run_record.hpp"
#include "versine/io/run_json.hpp"
#include "versine/sensors/imu_check.hpp"
#include "versine/sensors/measurements.hpp"

namespace versine::app {

/// A survey's recording, read, checked and repaired; empty series are sensors that the job does not name.
struct SurveyInput {
  sensors::CheckedImu imu;
  Series<sensors::GnssSample> gnss;
  std::vector<Series<sensors::OdometerSample>> odometers;
  Series<sensors::SpeedSample> speed;
  Series<sensors::HeadingSample> heading;
  Series<sensors::LandmarkSample> landmarks;
  std::optional<StationingOutcome> total_station;  ///< where the landmarks come from
  RunRecord record;
  std::vector<io::RunInput> files;
};

/// Stages 1 and 2 of a survey: read every file of the job, check each sensor by itself and all of them together.
[[nodiscard]] Expected<SurveyInput> read_survey_input(const SurveyConfig& config, const std::filesystem::path& job,
                                                      Progress& progress);

/// One line a sensor: samples, rate, time span; for `versine check`.
[[nodiscard]] std::vector<std::string> describe_input(const SurveyInput& input);

}  // namespace versine::app
