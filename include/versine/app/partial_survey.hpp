// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "versine/app/survey.hpp"
#include "versine/geodesy/projection.hpp"
#include "versine/io/result_folder.hpp"

namespace versine::app {

/// What a survey knows before it is finished, for `versine view`: small result folders `partial/1`, `partial/2`, ... in
/// the folder that the job is writing, each whole once its run.json is there: trajectory.csv (of the forward filter,
/// then smoothed), innovations.csv of the landmarks, and in run.json under `results` the stage, counts, standstills,
/// and where fixes and landmarks were measured. Written at most every half second and for a fiftieth of the time; the
/// last two are kept. What cannot be written is left out: a full disk is the job's own business.
class PartialSurvey final : public SurveyWatch {
 public:
  static constexpr const char* name = "partial";

  PartialSurvey(const SurveyConfig& config, io::ResultFolder& folder);
  void read(const SurveyInput& input) override;
  void forward(const geodesy::TrajectoryPoint& now, const fusion::AidedInsResult& so_far) override;
  void solved(const fusion::AidedInsResult& estimate) override;

 private:
  using Clock = std::chrono::steady_clock;
  void publish(const char* stage, const geodesy::Trajectory& track, const fusion::AidedInsResult& found);
  [[nodiscard]] std::string results_json(const char* stage, const geodesy::Trajectory& track,
                                         const fusion::AidedInsResult& found) const;

  std::filesystem::path folder_;
  std::string settings_json_, recorded_json_;
  std::string crs_;
  std::optional<geodesy::Projection> projection_;
  RunRecord checked_;  ///< of the recording
  geodesy::Trajectory track_;
  int number_ = 0;
  Clock::time_point next_{};
};

/// The newest partial result that the job behind `folder` (`running_job`) has published; nothing before the first.
[[nodiscard]] std::optional<std::filesystem::path> newest_partial(const std::filesystem::path& folder);

}  // namespace versine::app
