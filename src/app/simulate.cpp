// SPDX-License-Identifier: Apache-2.0
#include "versine/app/simulate.hpp"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "versine/io/write_recording.hpp"
#include "versine/simulation/simulate.hpp"
#include "versine/simulation/world.hpp"

namespace versine::app {

namespace {
Expected<void> write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  if (file << text && file.flush()) return {};
  return fail({.file = path.string(),
               .found = "the file could not be written",
               .expected = "a folder that can be written",
               .advice = "choose another folder with --output"});
}

/// One recording into an existing folder.
Expected<void> write_run(const std::filesystem::path& folder, const SimulateConfig& config,
                         const simulation::SimulatedRecording& recording, bool csv_truth) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (auto done = io::write_recording(folder, recording, {config.write_rates}); !done) {
    return tl::unexpected(std::move(done.error()));
  }
  if (auto done = io::write_truth(folder, recording.truth, csv_truth); !done) {
    return tl::unexpected(std::move(done.error()));
  }
  return write_text(folder / "survey.toml", survey_job(config, recording));
}

nlohmann::json summary_of(const simulation::World& world, const simulation::SimulatedRecording& r) {
  double way = 0.0;
  for (std::size_t i = 1; i < r.truth.progress.size(); ++i) {
    way += std::abs(r.truth.progress[i].distance - r.truth.progress[i - 1].distance);
  }
  std::size_t odometer = 0;
  for (const auto& o : r.odometers) odometer += o.size();
  return {{"duration_s", world.duration},       {"distance_m", way},
          {"standstills", world.stops.size()},  {"imu_samples", r.imu.size()},
          {"gnss_epochs", r.gnss.size()},       {"odometer_samples", odometer},
          {"gauge_samples", r.gauge.size()},    {"landmarks", r.landmarks.size()},
          {"stationings", r.stationings.size()}};
}

/// Replaces `target`, a folder that an earlier simulation made or that is not there, by `made`.
Expected<void> put_in_place(const std::filesystem::path& made, const std::filesystem::path& target) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::exists(target)) {
    const fs::path old = target.string() + ".old";
    fs::remove_all(old, error);
    fs::rename(target, old, error);
    if (!error) fs::rename(made, target, error);
    fs::remove_all(old);
  } else {
    fs::rename(made, target, error);
  }
  if (!error) return {};
  return fail({.file = target.string(),
               .found = error.message(),
               .expected = "a place for the recording",
               .advice = "choose another folder with --output"});
}
}  // namespace

Expected<SimulateRun> run_simulate(const std::filesystem::path& job, std::span<const std::string> overrides,
                                   const std::filesystem::path& output, int runs, int threads, Progress& progress) {
  namespace fs = std::filesystem;
  const auto begin = std::chrono::steady_clock::now();
  auto config = read_simulate_config(job, overrides);
  if (!config) return tl::unexpected(std::move(config.error()));
  if (!config->table_file.empty()) {
    auto table = io::read_deviations(config->table_file.path);
    if (!table) return tl::unexpected(std::move(table.error()));
    config->scenario.track.table = std::move(*table);
  }
  if (runs > 0) config->runs = runs;
  fs::path target = output.empty() ? fs::path(job).replace_extension(".recording") : output;
  target = fs::absolute(target).lexically_normal();
  if (!target.has_filename()) target = target.parent_path();
  if (fs::exists(target) && !fs::exists(target / "run.json") && !fs::is_empty(target)) {
    return fail({.file = target.string(),
                 .found = "a folder with other things in it",
                 .expected = "no folder, or an earlier recording",
                 .advice = "choose another folder with --output"});
  }
  progress.report("track and motion", 0.0);
  auto world = simulation::prepare(config->scenario);
  if (!world) {
    if (world.error().file.empty()) world.error().file = job.string();
    return tl::unexpected(std::move(world.error()));
  }
  const fs::path made = target.parent_path() / ("." + target.filename().string() + ".new");
  std::error_code error;
  fs::remove_all(made, error);
  fs::create_directories(made, error);
  if (error) {
    return fail({.file = made.string(),
                 .found = error.message(),
                 .expected = "a folder that can be written",
                 .advice = "choose another folder with --output"});
  }
  Expected<void> done;
  nlohmann::json summary;
  const bool several = config->runs > 1;
  simulation::simulate_runs(
      **world, static_cast<std::uint64_t>(config->seed), static_cast<std::uint64_t>(config->runs), threads,
      [&](std::uint64_t run, simulation::SimulatedRecording&& recording) {
        if (!done) return;
        const fs::path folder = several ? made / fmt::format("run_{:04d}", run) : made;
        done = write_run(folder, *config, recording, config->write_csv_truth && run == 0);
        if (run == 0) summary = summary_of(**world, recording);
      },
      progress);
  if (done && progress.cancelled()) {
    done = fail({.field = "simulate", .found = "cancelled", .expected = "", .advice = ""});
  }
  if (done) {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    summary["runs"] = config->runs;
    summary["seconds"] = seconds;
    const nlohmann::json run = {
        {"command", "simulate"},
        {"results", summary},
        {"settings", nlohmann::json::parse(config_json([&](ConfigVisitor& v) { describe(v, *config); }))}};
    done = write_text(made / "run.json", run.dump(2) + "\n");
  }
  if (done) done = put_in_place(made, target);
  if (!done) {
    fs::remove_all(made, error);
    return tl::unexpected(std::move(done.error()));
  }
  summary["folder"] = target.string();
  return SimulateRun{
      target, summary.dump(2),
      fmt::format("{:.1f} s of recording over {:.1f} m with {} standstills, {} run{}, in {}\nnext: versine "
                  "survey {}",
                  summary["duration_s"].get<double>(), summary["distance_m"].get<double>(), (*world)->stops.size(),
                  config->runs, several ? "s" : "", target.string(),
                  (target / (several ? "run_0000/survey.toml" : "survey.toml")).string())};
}

}  // namespace versine::app
