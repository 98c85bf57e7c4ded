// SPDX-License-Identifier: Apache-2.0
#include "versine/app/survey_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "versine/app/felt_up.hpp"
#include "versine/app/job_run.hpp"
#include "versine/io/read_recording.hpp"
#include "versine/sensors/plausibility.hpp"
#include "versine/sensors/series_check.hpp"

namespace versine::app {

namespace {

/// Reads one sensor's file and runs its check. `read` and `check` are the sensor's own.
template <class Config, class Out, class Read, class Check>
Expected<void> load(const Config& config, const char* role, const Read& read, const Check& check, SurveyInput& input,
                    Out& out) {
  auto file = io::describe_input(role, config.file.written, config.file.path);
  if (!file) return tl::unexpected(file.error());
  input.files.push_back(std::move(*file));
  auto raw = read(config.description);
  if (!raw) return tl::unexpected(raw.error());
  input.record.append(std::move(raw->record));
  auto checked = check(std::move(raw->series), config.file.path.string());
  if (!checked) return tl::unexpected(checked.error());
  input.record.append(std::move(checked->record));
  out = std::move(checked->series);
  return {};
}

template <class Sample>
using Checker = Expected<sensors::Checked<Sample>> (*)(Series<Sample>, const sensors::SeriesCheckOptions&);

template <class Sample>
auto with_options(Checker<Sample> checker) {
  return [checker](Series<Sample> series, std::string file) {
    return checker(std::move(series), sensors::SeriesCheckOptions{.file = std::move(file)});
  };
}

Expected<void> load_imu(const SurveyConfig& config, SurveyInput& input) {
  auto file = io::describe_input("imu", config.imu.file.written, config.imu.file.path);
  if (!file) return tl::unexpected(file.error());
  input.files.push_back(std::move(*file));
  auto raw = io::read_imu(config.imu.description);
  if (!raw) return tl::unexpected(raw.error());
  input.record.append(std::move(raw->record));
  const std::string name = config.imu.file.path.string();
  auto checked = sensors::check_imu(std::move(raw->series), {.file = name});
  if (!checked) return tl::unexpected(checked.error());
  input.imu = std::move(*checked);
  input.imu.series.samples.shrink_to_fit();  // what reading left over would stay through the whole run
  sensors::ImuPlausibilityOptions plausible{.file = name, .gyro_bias = config.estimator.imu_errors.gyro.bias};
  // A mounting that is declared leans the IMU on purpose.
  plausible.max_tilt = config.max_tilt.value_or(
      plausible.max_tilt + std::hypot(config.estimator.mounting.roll, config.estimator.mounting.pitch));
  auto record = sensors::check_imu_plausibility(input.imu, plausible);
  if (!record) return tl::unexpected(record.error());
  input.record.append(std::move(input.imu.record));
  input.record.append(std::move(*record));
  return {};
}

void keep_fixed(Series<sensors::GnssSample>& gnss, RunRecord& record) {
  const auto is_other = [](const sensors::GnssSample& s) { return s.fix != sensors::FixType::fixed; };
  for (const auto& s : gnss) {
    if (is_other(s)) record.rejections.push_back({.sensor = "gnss", .time = s.time, .reason = "not a fixed solution"});
  }
  std::erase_if(gnss.samples, is_other);
}

/// Observations of rover and base become the series that `load_gnss` would read.
Expected<void> solve_gnss(const SurveyConfig& config, SurveyInput& input, Progress& progress) {
  const GnssProcessing& g = config.gnss_raw;
  for (const auto& [role, files] :
       {std::pair{"gnss rover", &g.rover}, {"gnss base", &g.base}, {"gnss navigation", &g.navigation}}) {
    if (auto noted = note_files(role, *files, input.files); !noted) return noted;
  }
  SilentLog log;
  auto solved = process_gnss(g, progress, log);
  if (!solved) return tl::unexpected(solved.error());
  input.record.append(std::move(solved->record));
  input.gnss = std::move(solved->series);
  if (config.fixed_only) keep_fixed(input.gnss, input.record);
  auto record = sensors::check_gnss_plausibility(&input.imu, input.gnss, g.rover.front().written);
  if (!record) return tl::unexpected(record.error());
  input.record.append(std::move(*record));
  return {};
}

/// Raw readings become landmarks; a station during which the trolley moved is left out.
Expected<void> solve_total_station(const SurveyConfig& config, SurveyInput& input, Progress& progress) {
  const StationingProcessing& t = config.total_station;
  for (const auto& [role, files] : {std::pair{"total station", &t.readings}, {"control points", &t.control}}) {
    if (auto noted = note_files(role, *files, input.files); !noted) return noted;
  }
  SilentLog log;
  // An instrument that stands beside the track does not lean with the trolley.
  const bool carried = t.arrangement == StationingProcessing::Arrangement::on_trolley;
  auto solved = process_stationing(t, progress, log, [&](std::span<stationing::Stationing> stationings) {
    if (carried) feel_up(stationings, input.imu.series, config.estimator.imu_errors.accelerometer);
  });
  if (!solved) return tl::unexpected(solved.error());
  input.record.append(std::move(solved->record));
  inertial::StandstillInput seen{.imu = &input.imu.series};
  if (!input.odometers.empty() && !input.odometers.front().empty()) seen.odometer = &input.odometers.front();
  input.record.append({.rejections = require_standstill(solved->landmarks, inertial::find_standstills(seen))});
  input.landmarks.scale = t.time_scale;
  input.landmarks.samples.insert(input.landmarks.samples.end(), solved->landmarks.begin(), solved->landmarks.end());
  std::sort(input.landmarks.samples.begin(), input.landmarks.samples.end(),
            [](const auto& a, const auto& b) { return a.time < b.time; });
  input.total_station = std::move(*solved);
  return {};
}

Expected<void> load_gnss(const SurveyConfig& config, SurveyInput& input) {
  if (auto done = load(config.gnss, "gnss", io::read_gnss, with_options<sensors::GnssSample>(sensors::check_gnss),
                       input, input.gnss);
      !done) {
    return done;
  }
  if (config.fixed_only) keep_fixed(input.gnss, input.record);
  auto record = sensors::check_gnss_plausibility(&input.imu, input.gnss, config.gnss.file.path.string());
  if (!record) return tl::unexpected(record.error());
  input.record.append(std::move(*record));
  return {};
}

Expected<void> check_extents(const SurveyConfig& config, const SurveyInput& input) {
  std::vector<sensors::Extent> extents;
  const auto add = [&](const char* sensor, const InputPath& file, const auto& series) {
    if (!series.empty()) {
      extents.push_back({sensor, file.path.string(), series.scale, series.front().time, series.back().time});
    }
  };
  add("imu", config.imu.file, input.imu.series);
  add("gnss", config.gnss.file, input.gnss);
  for (std::size_t i = 0; i < input.odometers.size(); ++i) {
    add("odometer", config.odometers[i].file, input.odometers[i]);
  }
  add("speed", config.speed.file, input.speed);
  add("heading", config.heading.file, input.heading);
  add("landmarks", config.landmarks.file, input.landmarks);
  return sensors::check_overlap(extents);
}

}  // namespace

Expected<SurveyInput> read_survey_input(const SurveyConfig& config, const std::filesystem::path& job,
                                        Progress& progress) {
  SurveyInput input;
  auto job_file = io::describe_input("job", job.string(), job);
  if (!job_file) return tl::unexpected(job_file.error());
  input.files.push_back(std::move(*job_file));

  std::vector<std::function<Expected<void>()>> stages;
  stages.emplace_back([&] { return load_imu(config, input); });
  if (config.gnss.given()) stages.emplace_back([&] { return load_gnss(config, input); });
  if (!config.gnss_raw.rover.empty()) stages.emplace_back([&] { return solve_gnss(config, input, progress); });
  input.odometers.resize(config.odometers.size());
  for (std::size_t i = 0; i < config.odometers.size(); ++i) {
    stages.emplace_back([&, i] {
      return load(config.odometers[i], "odometer", io::read_odometer,
                  with_options<sensors::OdometerSample>(sensors::check_odometer), input, input.odometers[i]);
    });
  }
  if (config.speed.given()) {
    stages.emplace_back([&] {
      return load(config.speed, "speed", io::read_speed, with_options<sensors::SpeedSample>(sensors::check_speed),
                  input, input.speed);
    });
  }
  if (config.heading.given()) {
    stages.emplace_back([&] {
      return load(config.heading, "heading", io::read_heading,
                  with_options<sensors::HeadingSample>(sensors::check_heading), input, input.heading);
    });
  }
  if (config.landmarks.given()) {
    stages.emplace_back([&] {
      return load(config.landmarks, "landmarks", io::read_landmarks,
                  with_options<sensors::LandmarkSample>(sensors::check_landmarks), input, input.landmarks);
    });
  }
  if (!config.total_station.readings.empty()) {
    stages.emplace_back([&] { return solve_total_station(config, input, progress); });
  }
  for (std::size_t i = 0; i < stages.size(); ++i) {
    progress.report("reading", static_cast<double>(i) / static_cast<double>(stages.size()));
    if (progress.cancelled()) return fail({.found = "cancelled"});
    if (auto done = stages[i](); !done) return tl::unexpected(done.error());
  }
  if (auto done = check_extents(config, input); !done) return tl::unexpected(done.error());
  if (!input.odometers.empty() && !input.odometers.front().empty() && !input.gnss.empty()) {
    auto fine = sensors::check_gnss_way(input.gnss, input.odometers.front(), config.gnss.file.path.string());
    if (!fine) return tl::unexpected(fine.error());
  }
  progress.report("reading", 1.0);
  return input;
}

std::vector<std::string> describe_input(const SurveyInput& input) {
  std::vector<std::string> lines;
  const auto add = [&](const char* sensor, const auto& series) {
    if (series.empty()) return;
    const double span = (series.back().time - series.front().time).seconds();
    lines.push_back(fmt::format("{}: {} samples over {:.1f} s ({:.4g} Hz)", sensor, series.size(), span,
                                span > 0.0 ? static_cast<double>(series.size() - 1) / span : 0.0));
  };
  add("imu", input.imu.series);
  if (input.imu.segments.size() > 1) lines.push_back(fmt::format("imu: {} segments", input.imu.segments.size()));
  add("gnss", input.gnss);
  for (const auto& odometer : input.odometers) add("odometer", odometer);
  add("speed", input.speed);
  add("heading", input.heading);
  add("landmarks", input.landmarks);
  for (const Finding& f : input.record.findings) {
    lines.push_back(fmt::format("{}: {} x {}, {}{}{}", f.sensor, f.count, f.kind, to_string(f.action),
                                f.detail.empty() ? "" : ": ", f.detail));
  }
  for (const std::string& warning : input.record.warnings) lines.push_back("warning: " + warning);
  return lines;
}

}  // namespace versine::app
