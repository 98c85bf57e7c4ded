// SPDX-License-Identifier: Apache-2.0
// What a simulated recording costs: an hour of a trolley with everything on it, and Monte Carlo sets of two minutes.
#include <benchmark/benchmark.h>

#include "support/trolley_scenario.hpp"
#include "versine/simulation/simulate.hpp"

namespace {
using namespace versine;
using namespace versine::simulation;

/// With an odometer and a total station.
Scenario surveying_trolley(double length, double speed, double stand) {
  Scenario s = trolley_on(length, speed, stand);
  s.equipment.odometers = {{}};
  s.equipment.total_station = TotalStationModel{};
  return s;
}

void hour_of_a_trolley(benchmark::State& state) {
  Scenario s = surveying_trolley(3400.0, 1.0, 180.0);
  s.equipment.odometers.push_back({.wheel = OdometerModel::Wheel::a3});
  s.equipment.gauge = GaugeModel{};
  s.equipment.sleeper = SleeperModel{};
  s.equipment.gnss = GnssModel{};
  for (auto _ : state) {
    auto recording = simulate(s, 1);
    if (!recording) return state.SkipWithError(recording.error().message().c_str());
    benchmark::DoNotOptimize(recording);
  }
}
BENCHMARK(hour_of_a_trolley)->Unit(benchmark::kSecond);

void runs_of_two_minutes(benchmark::State& state) {
  Scenario s = surveying_trolley(120.0, 1.0, 5.0);
  s.equipment.imu->instability = ImuModel::Instability::flicker;
  const auto world = prepare(s);
  if (!world) return state.SkipWithError(world.error().message().c_str());
  SilentProgress progress;
  for (auto _ : state) {
    simulate_runs(
        **world, 1, static_cast<std::size_t>(state.range(0)), 0,
        [](auto, auto&& recording) { benchmark::DoNotOptimize(recording); }, progress);
  }
}
BENCHMARK(runs_of_two_minutes)->Arg(500)->Unit(benchmark::kSecond)->UseRealTime()->Iterations(1);

}  // namespace
