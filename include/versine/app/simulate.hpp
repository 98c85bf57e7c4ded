// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "versine/app/simulate_config.hpp"
#include "versine/core/progress.hpp"
#include "versine/simulation/recording.hpp"
#include "versine/simulation/world.hpp"

/// `versine simulate`: from a scenario file to a folder with recording, truth, and a survey job that is ready to run.
namespace versine::app {

/// What a scenario comes to before any sensor looks at it.
struct SimulatedWorld {
  std::shared_ptr<const simulation::World> world;  ///< rails, motion, error-free IMU
  std::optional<JourneyNetwork> map;               ///< of a journey
};
[[nodiscard]] Expected<SimulatedWorld> prepare_world(const SimulateConfig& config);

struct SimulateRun {
  std::filesystem::path folder;
  std::string summary_json;
  std::string summary_text;
};

/// Runs a scenario. `output` overrides the folder (default: the scenario's name with .recording, beside it); `runs`
/// above 0 overrides the scenario's number. Several runs go to run_0000, run_0001, ... in that folder; they share truth
/// but for the sensors' constants. The folder appears whole or not at all.
[[nodiscard]] Expected<SimulateRun> run_simulate(const std::filesystem::path& job,
                                                 std::span<const std::string> overrides,
                                                 const std::filesystem::path& output, int runs, int threads,
                                                 Progress& progress);

/// The survey job that processes such a recording, as TOML. `with_design`: design.xml lies beside it.
[[nodiscard]] std::string survey_job_for(const SimulateConfig& config, const simulation::SimulatedRecording& recording,
                                         bool with_design = false);

}  // namespace versine::app
