// SPDX-License-Identifier: Apache-2.0
#include "versine/app/simulate.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "versine/app/job_run.hpp"
#include "versine/io/landxml.hpp"
#include "versine/io/result_folder.hpp"
#include "versine/io/run_json.hpp"
#include "versine/io/write_journey.hpp"
#include "versine/io/write_recording.hpp"
#include "versine/simulation/simulate.hpp"
#include "versine/simulation/world.hpp"

namespace versine::app {

namespace {
using json = nlohmann::ordered_json;

Expected<void> write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  if (file << text && file.flush()) return {};
  return fail({.file = path.string(),
               .found = "the file could not be written",
               .expected = "a folder that can be written",
               .advice = "choose another folder with --output"});
}

/// One recording into a folder of its own.
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
  if (!config.journey.present) {
    // LandXML has no words for some transitions: such a line goes without its design.
    const bool with_design =
        !config.has_vehicle &&
        io::write_landxml(folder / "design.xml", {&config.scenario.track.alignment, 1}).has_value();
    return write_text(folder / "survey.toml", survey_job_for(config, recording, with_design));
  }
  if (auto done = io::write_onboard(folder / "journey.h5", recording); !done) return done;
  return write_text(folder / "georef.toml", georef_job_for(config.journey));
}

Expected<std::shared_ptr<const simulation::World>> world_of(const SimulateConfig& c, const JourneyNetwork* map) {
  if (map == nullptr) return simulation::prepare(c.scenario);
  simulation::JourneyScenario journey{.name = c.title,
                                      .stops = c.journey.stops,
                                      .vehicle = c.vehicle,
                                      .height = c.journey.height,
                                      .smoothing = c.journey.smoothing,
                                      .equipment = c.scenario.equipment,
                                      .start = c.scenario.start,
                                      .time_scale = c.scenario.time_scale,
                                      .truth_rate = c.scenario.truth_rate};
  return simulation::prepare_journey(map->network, journey);
}

json summary_of(const simulation::World& world, const simulation::SimulatedRecording& r) {
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

/// run.json, for the folder to be known as Versine's own and the recording to be made again.
Expected<void> write_record(io::Run run, const io::ResultFolder& folder, const std::filesystem::path& job,
                            const SimulateConfig& config, const json& summary, double seconds) {
  run.time_scale = config.scenario.time_scale;
  auto input = io::describe_input("job", job.string(), job);
  if (!input) return tl::unexpected(std::move(input.error()));
  run.inputs.push_back(std::move(*input));
  SimulateConfig described = config;
  run.settings_json = config_json([&](ConfigVisitor& v) { describe(v, described); });
  run.results_json = summary.dump();
  run.timings_s = {{"simulate and write", seconds}};
  return io::write_run_json(folder.path("run.json"), run);
}
}  // namespace

Expected<SimulatedWorld> prepare_world(const SimulateConfig& config) {
  SimulatedWorld out;
  if (config.journey.present) {
    auto loaded = load_network(config.journey);
    if (!loaded) return tl::unexpected(std::move(loaded.error()));
    out.map = std::move(*loaded);
  }
  auto world = world_of(config, out.map ? &*out.map : nullptr);
  if (!world) return tl::unexpected(std::move(world.error()));
  out.world = std::move(*world);
  return out;
}

Expected<SimulateRun> run_simulate(const std::filesystem::path& job, std::span<const std::string> overrides,
                                   const std::filesystem::path& output, int runs, int threads, Progress& progress) {
  namespace fs = std::filesystem;
  const auto begin = std::chrono::steady_clock::now();
  auto config = read_simulate_config(job, overrides);
  if (!config) return tl::unexpected(std::move(config.error()));
  if (runs > 0) config->runs = runs;
  auto folder = io::ResultFolder::create(output.empty() ? fs::path(job).replace_extension(".recording") : output);
  if (!folder) return tl::unexpected(std::move(folder.error()));
  progress.report("track and motion", 0.0);
  io::Run begun = begin_run("simulate");
  auto prepared = prepare_world(*config);
  if (!prepared) return tl::unexpected(std::move(prepared.error()));
  const auto& [world, map] = *prepared;
  Expected<void> done;
  json summary;
  const bool several = config->runs > 1;
  simulation::simulate_runs(
      *world, static_cast<std::uint64_t>(config->seed), static_cast<std::uint64_t>(config->runs), threads,
      [&, &world = world, &map = map](std::uint64_t run, simulation::SimulatedRecording&& recording) {
        if (!done) return;
        const fs::path where = several ? folder->path(fmt::format("run_{:04d}", run)) : folder->folder();
        done = write_run(where, *config, recording, config->write_csv_truth && run == 0);
        // Beside each recording, since its job names it so.
        if (done && map && map->source) done = io::write_network_geojson(where / "network.geojson", *map->source);
        if (run == 0) summary = summary_of(*world, recording);
      },
      progress);
  if (done && progress.cancelled()) done = fail({.found = "cancelled"});
  if (!done) return tl::unexpected(std::move(done.error()));
  summary["runs"] = config->runs;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (done = write_record(std::move(begun), *folder, job, *config, summary, seconds); !done) {
    return tl::unexpected(std::move(done.error()));
  }
  if (done = folder->commit(); !done) return tl::unexpected(std::move(done.error()));
  summary["folder"] = folder->target().string();
  return SimulateRun{
      folder->target(), summary.dump(2),
      fmt::format("{:.1f} s of recording over {:.1f} m with {} standstills, {} run{}\nnext: versine {} {}\n",
                  summary["duration_s"].get<double>(), summary["distance_m"].get<double>(), world->stops.size(),
                  config->runs, several ? "s" : "", map ? "georef" : "survey",
                  (folder->target() / (several ? "run_0000" : "") / (map ? "georef.toml" : "survey.toml")).string())};
}

}  // namespace versine::app
