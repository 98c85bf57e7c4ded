// SPDX-License-Identifier: Apache-2.0
// What a simulated recording costs: an hour of a trolley with everything on it, and Monte Carlo sets of two minutes.
#include <benchmark/benchmark.h>

#include "versine/simulation/simulate.hpp"

namespace {
using namespace versine;
using namespace versine::simulation;

Scenario trolley_on(double length, double speed, double stand) {
  Scenario s;
  s.track.alignment.crs = "+proj=tmerc +lat_0=0 +lon_0=9 +k=1 +x_0=500000 +ellps=GRS80 +units=m";
  s.track.alignment.horizontal = *design::HorizontalAxis::chain(
      {510000.0, 5300000.0, 0.7}, {design::line(length / 2), design::arc(length / 2, 800.0)});
  s.track.spectrum = Spectrum::china_ballastless;
  s.motion = {.start = 5.0, .stand = stand, .legs = {{.to = length - 5.0, .speed = speed, .stop = 10.0}}};
  s.equipment.imu = ImuModel{.errors = sensors::find_imu_grade("fog")->errors};
  s.equipment.odometers = {{}};
  s.equipment.total_station = TotalStationModel{};
  return s;
}

void hour_of_a_trolley(benchmark::State& state) {
  Scenario s = trolley_on(3400.0, 1.0, 180.0);
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
  Scenario s = trolley_on(120.0, 1.0, 5.0);
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
