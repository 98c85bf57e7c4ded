// SPDX-License-Identifier: Apache-2.0
#include "versine/app/survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "versine/app/job_run.hpp"
#include "versine/app/partial_survey.hpp"
#include "versine/app/progress_file.hpp"
#include "versine/app/report.hpp"
#include "versine/app/survey_landmark.hpp"
#include "versine/app/survey_output.hpp"
#include "versine/app/withhold.hpp"
#include "versine/core/units.hpp"

namespace versine::app {

namespace {

/// Wall time of each stage, for run.json.
class Stopwatch {
 public:
  explicit Stopwatch(std::vector<std::pair<std::string, double>>& timings) : timings_(timings) {}
  void stage(std::string name) {
    const auto now = std::chrono::steady_clock::now();
    timings_.emplace_back(std::move(name), std::chrono::duration<double>(now - last_).count());
    last_ = now;
  }

 private:
  std::vector<std::pair<std::string, double>>& timings_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Takes the series over: hours of IMU are not held twice.
fusion::AidedInsInput estimator_input(SurveyInput& input) {
  fusion::AidedInsInput out;
  for (std::size_t i = 1; i < input.imu.segments.size(); ++i) {
    out.segment_starts.push_back(input.imu.series[input.imu.segments[i].begin].time);
  }
  out.imu = std::move(input.imu.series);
  out.gnss = input.gnss;
  if (!input.odometers.empty()) out.odometer = input.odometers.front();
  out.speed = input.speed;
  out.landmarks = input.landmarks;
  out.heading = input.heading;
  return out;
}

}  // namespace

Expected<SurveyResult> compute_survey(const SurveyConfig& config, const std::filesystem::path& job, Progress& progress,
                                      Log& log, SurveyWatch* onlooker) {
  SurveyResult result;
  Stopwatch watch(result.timings_s);
  auto input = read_survey_input(config, job, progress);
  if (!input) return tl::unexpected(input.error());
  watch.stage("read and check");
  for (const Finding& f : input->record.findings) {
    log.info(fmt::format("{}: {} x {}, {}", f.sensor, f.count, f.kind, to_string(f.action)));
  }

  if (onlooker != nullptr) onlooker->read(*input);
  fusion::AidedInsInput estimator = estimator_input(*input);
  Series<sensors::GnssSample> hidden;
  if (config.withhold.window > 0.0) hidden = withhold(estimator.gnss, config.withhold);
  auto solved = config.method == SurveyMethod::landmark
                    ? solve_by_landmarks(estimator, config.estimator, config.landmark_method, progress)
                    : fusion::run_aided_ins(estimator, config.estimator, progress, log, onlooker);
  if (!solved) return tl::unexpected(solved.error());
  if (onlooker != nullptr) onlooker->solved(*solved);
  if (!hidden.empty()) {
    result.withheld = compare_withheld(hidden, solved->solution.smoothed, config.estimator.gnss_lever.l_b);
  }
  const auto longest = std::max_element(solved->standstills.begin(), solved->standstills.end(),
                                        [](const auto& a, const auto& b) { return a.seconds() < b.seconds(); });
  if (longest != solved->standstills.end()) {
    const auto rate = inertial::measured_earth_rate(estimator.imu, *longest, config.estimator.imu_errors);
    if (rate && rate->sigma < 3.0 * units::deg_per_hour) {
      const auto& place = solved->solution.smoothed.empty() ? solved->solution.forward : solved->solution.smoothed;
      if (!place.empty()) {
        const std::string positions = config.gnss.given() ? config.gnss.file.path.string() : job.string();
        const auto fine = inertial::check_latitude(*rate, place.front().position, positions);
        if (!fine) return tl::unexpected(fine.error());
      }
      result.earth_rate = rate;
    }
  }
  watch.stage("align, filter and smooth");
  if (config.total_station.check_control && input->total_station) {
    auto checked = check_control(*input->total_station, config.total_station, std::move(estimator), config.estimator,
                                 progress, log);
    if (!checked) return tl::unexpected(checked.error());
    result.control = std::move(*checked);
    watch.stage("control points");
  }
  if (config.geometry.present) {
    const auto& solution = solved->solution;
    auto geometry = compute_track_geometry(config.geometry, solution.smoothed, &solution.chain, input->odometers,
                                           config.output.crs, progress);
    if (!geometry) return tl::unexpected(geometry.error());
    result.geometry = std::move(*geometry);
    watch.stage("track geometry");
  }
  result.input = std::move(*input);
  result.estimate = std::move(*solved);
  return result;
}

Expected<SurveyRun> run_survey(const std::filesystem::path& job, std::span<const std::string> overrides,
                               const std::filesystem::path& output, Progress& progress, Log& log) {
  auto config = read_survey_config(job, overrides);
  if (!config) return tl::unexpected(config.error());
  if (auto done = check_report(config->report); !done) return tl::unexpected(done.error());
  io::Run run = begin_run("survey");
  auto writer = io::ResultFolder::create(result_target(job, output, config->output.folder));
  if (!writer) return tl::unexpected(writer.error());
  ProgressFile visible(progress, *writer);
  NotedLog noted(log, visible);
  PartialSurvey partial(*config, *writer);
  auto result = compute_survey(*config, job, visible, noted, &partial);
  if (!result) return tl::unexpected(result.error());
  return write_survey(*config, *result, std::move(run), *writer, visible);
}

}  // namespace versine::app
