// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "versine/app/geometry_config.hpp"
#include "versine/app/gnss.hpp"
#include "versine/app/recording_config.hpp"
#include "versine/app/report_config.hpp"
#include "versine/app/stationing.hpp"
#include "versine/fusion/aided_ins.hpp"
#include "versine/fusion/landmark_options.hpp"

/// What a survey job says: `[imu]`, `[gnss]`, ... as in docs/job-survey.md, which is made from `describe`.
namespace versine::app {

enum class SurveyMethod { aided_ins, landmark };

struct SurveyConfig {
  /// Innovations each second keep hours of recording small.
  SurveyConfig() { estimator.innovation_interval = 1.0; }

  std::string job = "survey";
  std::string title;
  SurveyMethod method = SurveyMethod::aided_ins;

  ImuFileConfig imu;
  ImuErrorsConfig imu_errors;
  std::optional<double> max_tilt;  ///< rad; gravity further from the IMU's down axis is an error in axes
  GnssFileConfig gnss;
  GnssProcessing gnss_raw;  ///< instead of `gnss`: observations of rover and base
  bool fixed_only = false;
  std::vector<OdometerFileConfig> odometers;
  SpeedFileConfig speed;
  HeadingFileConfig heading;
  LandmarkFileConfig landmarks;
  StationingProcessing total_station;  ///< instead of `landmarks`: raw readings

  /// Everything the estimator wants to know; the keys of the job write straight into it.
  fusion::AidedInsOptions estimator;
  std::vector<double> initial_position;     ///< deg, deg, m
  fusion::LandmarkOptions landmark_method;  ///< what `method = "landmark"` wants to know besides

  GeometryConfig geometry;  ///< track geometry, when the job has the table
  ReportConfig report;

  struct Output {
    std::string folder;
    std::string crs;
    std::optional<double> rate;  ///< Hz of the trajectory; becomes the estimator's
    bool csv = true;
    bool hdf5 = true;
    bool innovations = true;
  } output;

  /// GNSS left out in windows, and compared with the solution.
  struct Withhold {
    double window = 0.0;  ///< s; 0: none
    double every = 0.0;   ///< s between the starts of two windows
    double start = 60.0;  ///< s after the first epoch
  } withhold;
};

void describe(ConfigVisitor& v, SurveyConfig& c);

/// Reads a survey job.
[[nodiscard]] Expected<SurveyConfig> read_survey_config(const std::filesystem::path& job,
                                                        std::span<const std::string> overrides = {});

}  // namespace versine::app
