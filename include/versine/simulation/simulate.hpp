// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>

#include "versine/core/error.hpp"
#include "versine/core/progress.hpp"
#include "versine/simulation/recording.hpp"
#include "versine/simulation/scenario.hpp"

namespace versine::simulation {

class World;

/// Checks a scenario: the track is there where the body goes, motion arrives, numbers make sense. The Error names the
/// key of the scenario file ("track.cant[2].cant_mm", "motion.leg[1].speed_kmh") and the cure.
[[nodiscard]] Expected<void> check(const Scenario& scenario);

/// What all runs of a scenario share: rails, motion and the error-free IMU. Immutable; used by any number of threads.
[[nodiscard]] Expected<std::shared_ptr<const World>> prepare(const Scenario& scenario);

/// One run: the sensors' errors are drawn from `seed`. Pure.
[[nodiscard]] SimulatedRecording observe(const World& world, std::uint64_t seed);

/// prepare and observe. For many runs of one scenario prepare once.
[[nodiscard]] Expected<SimulatedRecording> simulate(const Scenario& scenario, std::uint64_t seed);

/// Runs 0 to runs-1 with `run_seed(seed, run)` on `threads` threads (0: all cores). `use` gets each run, in any
/// order, one at a time; what it gets does not depend on the number of threads.
void simulate_runs(const World& world, std::uint64_t seed, std::uint64_t runs, int threads,
                   const std::function<void(std::uint64_t run, SimulatedRecording&&)>& use, Progress& progress);

}  // namespace versine::simulation
