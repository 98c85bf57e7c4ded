// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "versine/core/units.hpp"
#include "versine/fusion/landmark_dead_reckoning.hpp"
#include "versine/fusion/planning_methods.hpp"
#include "versine/fusion/planning_search.hpp"
#include "versine/simulation/straight_run.hpp"

namespace {

using namespace versine;

/// An hour at 200 Hz with a landmark every 60 m.
const simulation::StraightRecording& hour() {
  static const auto recording = [] {
    simulation::StraightRun run{.latitude = 50 * units::deg, .heading = 0.5, .speed = 1.0};
    run.spacing.assign(40, 60.0);
    run.stand_first = 902.0;
    run.stand = 10.0;
    run.rate = 200.0;
    run.gyro = {.bias = 0.03 * units::deg_per_hour, .random_walk = 0.005 * units::deg_per_sqrt_hour};
    run.landmark = 0.6 * units::mm;
    return simulate_straight(run, 1);
  }();
  return recording;
}

void process(benchmark::State& state) {
  const auto& r = hour();
  fusion::LandmarkOptions options;
  options.gyro = {.bias = 0.03 * units::deg_per_hour, .random_walk = 0.005 * units::deg_per_sqrt_hour};
  options.smoother = state.range(0) == 0 ? fusion::LandmarkSmoother::rts : fusion::LandmarkSmoother::two_filter;
  SilentProgress silent;
  std::size_t samples = 0;
  for (auto _ : state) {
    auto solved = fusion::run_landmark_dead_reckoning({&r.imu, &r.odometer, &r.landmarks}, options, silent);
    samples += solved->solution.smoothed.size();
    benchmark::DoNotOptimize(solved);
  }
  state.counters["samples/s"] = benchmark::Counter(static_cast<double>(samples), benchmark::Counter::kIsRate);
}
BENCHMARK(process)->Arg(0)->Arg(1)->ArgName("two_filter")->Unit(benchmark::kMillisecond);

void plan(benchmark::State& state) {
  fusion::PlanCase p;
  p.gyro = sensors::find_imu_grade("rlg-jiang")->errors.gyro;
  p.accelerometer = sensors::find_imu_grade("rlg-jiang")->errors.accelerometer;
  p.level = 0.005 * units::deg;
  p.landmark = 0.6 * units::mm;
  p.latitude = 50 * units::deg;
  for (auto _ : state) {
    benchmark::DoNotOptimize(fusion::chain_accuracy(p));
    benchmark::DoNotOptimize(fusion::largest_spacing(p, 0.67 * units::mm, fusion::PlanBasis::chain));
    benchmark::DoNotOptimize(fusion::method_accuracy(p, fusion::PlanMethod::ins_odometer_landmark));
  }
}
BENCHMARK(plan)->Unit(benchmark::kMillisecond);

}  // namespace
