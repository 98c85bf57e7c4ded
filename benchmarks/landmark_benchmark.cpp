// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <limits>

#include "versine/core/units.hpp"
#include "versine/fusion/landmark_dead_reckoning.hpp"
#include "versine/fusion/planning_methods.hpp"
#include "versine/fusion/planning_search.hpp"
#include "versine/simulation/simulate.hpp"
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
  options.output_rate = static_cast<double>(state.range(1));
  SilentProgress silent;
  std::size_t samples = 0;
  for (auto _ : state) {
    auto solved = fusion::run_landmark_dead_reckoning({&r.imu, &r.odometer, &r.landmarks}, options, silent);
    samples += 200 * static_cast<std::size_t>((solved->solution.smoothed.back().time - r.imu[180000].time).seconds());
    benchmark::DoNotOptimize(solved);
  }
  state.counters["samples/s"] = benchmark::Counter(static_cast<double>(samples), benchmark::Counter::kIsRate);
}
BENCHMARK(process)
    ->Args({0, 0})
    ->Args({1, 0})
    ->Args({0, 10})
    ->ArgNames({"two_filter", "output_hz"})
    ->Unit(benchmark::kMillisecond);

/// Half an hour at 200 Hz through curves of R = 800 m with cant, where the nodes are laid twice.
void process_curves(benchmark::State& state) {
  static const auto recording = [] {
    simulation::Scenario s;
    s.track.alignment.crs = "+proj=tmerc +lat_0=0 +lon_0=9 +k=1 +x_0=500000 +ellps=GRS80 +units=m";
    const double straight = std::numeric_limits<double>::infinity();
    s.track.alignment.horizontal = *design::HorizontalAxis::chain(
        {500000.0, 5250000.0, 0.5},
        {design::line(200.0), design::transition(design::Shape::clothoid, 100.0, straight, 800.0),
         design::arc(600.0, 800.0), design::transition(design::Shape::clothoid, 100.0, 800.0, straight),
         design::line(200.0)});
    s.track.alignment.cant = *design::CantProfile::from_points({{.distance = 200.0},
                                                                {.distance = 300.0, .cant = 0.1},
                                                                {.distance = 900.0, .cant = 0.1},
                                                                {.distance = 1000.0}});
    s.motion.start = 20.0;
    s.motion.stand = 300.0;
    s.motion.legs = {{.to = 1180.0, .speed = 1.0, .stop = 20.0, .stop_every = 60.0, .stop_each = 20.0}};
    simulation::ImuModel imu;
    imu.rate = 200.0;
    imu.errors = sensors::find_imu_grade("rlg-jiang")->errors;
    s.equipment.imu = imu;
    s.equipment.odometers.push_back({.quantum = 0.1 * units::mm, .scale = 1e-3});
    s.equipment.total_station = simulation::TotalStationModel{};
    return *simulation::simulate(s, 1);
  }();
  Series<sensors::LandmarkSample> landmarks;
  landmarks.samples = recording.landmarks;
  fusion::LandmarkOptions options;
  options.gyro = sensors::find_imu_grade("rlg-jiang")->errors.gyro;
  options.lever_odometer = {0.0, -0.7175, 0.5};
  options.lever_landmark = {0.0, 0.0, -0.8};
  SilentProgress silent;
  std::size_t samples = 0;
  for (auto _ : state) {
    auto solved =
        fusion::run_landmark_dead_reckoning({&recording.imu, &recording.odometers[0], &landmarks}, options, silent);
    samples += solved->solution.smoothed.size();
    benchmark::DoNotOptimize(solved);
  }
  state.counters["samples/s"] = benchmark::Counter(static_cast<double>(samples), benchmark::Counter::kIsRate);
}
BENCHMARK(process_curves)->Unit(benchmark::kMillisecond);

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
