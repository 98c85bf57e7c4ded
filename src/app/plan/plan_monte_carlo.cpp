// SPDX-License-Identifier: Apache-2.0
#include "versine/app/plan_monte_carlo.hpp"

#include <fmt/format.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>

#include "versine/fusion/landmark_dead_reckoning.hpp"
#include "versine/geodesy/ellipsoid.hpp"
#include "versine/simulation/random.hpp"
#include "versine/simulation/straight_run.hpp"

namespace versine::app {

namespace {

constexpr int places_per_interval = 6;
constexpr double stand_at_landmark = 1.2;  // s: what the method needs to see that the trolley stands

/// Errors along the track's directions at each place, and the filter's own covariance of them.
struct RunErrors {
  std::vector<Eigen::Vector3d> error;  ///< lateral, vertical, longitudinal
  std::vector<Eigen::Matrix3d> covariance;
};

simulation::StraightRun straight_run(const MonteCarloSetup& setup) {
  const auto& p = setup.plan;
  simulation::StraightRun run;
  run.latitude = p.latitude;
  run.heading = p.heading;
  run.speed = p.speed;
  run.spacing.assign(static_cast<std::size_t>(p.intervals), p.spacing);
  run.stand = std::max(p.stand, stand_at_landmark);
  run.stand_first = setup.static_start > 0.0 ? setup.static_start + 2.0 : stand_at_landmark;
  run.rate = setup.rate;
  run.gyro = setup.simulated_gyro;
  run.flicker = setup.flicker;
  run.accelerometer = p.accelerometer;
  run.scale = p.scale;
  run.scale_walk = p.scale_walk;
  run.distance_walk = p.distance_walk;
  run.path_walk = p.path_walk;
  run.landmark = p.landmark;
  return run;
}

fusion::LandmarkOptions filter_options(const MonteCarloSetup& setup) {
  const auto& p = setup.plan;
  const auto derived = fusion::derive(p);
  fusion::LandmarkOptions o;
  o.gyro = p.gyro;
  o.pitch_sigma = p.level;
  o.levelling_sigma = p.level;
  o.scale_sigma = p.scale;
  o.scale_walk = p.scale_walk;
  o.path_walk = p.path_walk;
  o.distance_walk = p.distance_walk;
  o.alignment_duration = setup.static_start;
  if (!(setup.static_start > 0.0)) o.bias_sigma = std::max(derived.bias.lateral, derived.bias.vertical);
  o.mounting_sigma = 0.0;
  o.chain_interval = 0.0;
  o.gate = 1e6;  // the simulation has no blunders; noise that the plan does not know must not look like one
  return o;
}

Expected<RunErrors> one_run(const MonteCarloSetup& setup, const simulation::StraightRun& run,
                            fusion::LandmarkOptions options, std::uint64_t seed, const std::vector<double>& places) {
  const auto recording = simulation::simulate_straight(run, seed);
  if (!(setup.static_start > 0.0)) {
    simulation::RandomStream random(seed, "attitude");
    const double heading_error = fusion::derive(setup.plan).heading_error;
    fusion::GivenAttitude given{recording.attitude, setup.plan.level, heading_error};
    given.attitude.roll += setup.plan.level * random.normal();
    given.attitude.pitch += setup.plan.level * random.normal();
    given.attitude.yaw += heading_error * random.normal();
    options.attitude = given;
  }
  SilentProgress silent;
  const auto solved =
      fusion::run_landmark_dead_reckoning({&recording.imu, &recording.odometer, &recording.landmarks}, options, silent);
  if (!solved) return tl::unexpected(solved.error());
  const auto& points = solved->solution.smoothed;
  const std::size_t first = recording.imu.size() - points.size();
  const double c = std::cos(run.heading), s = std::sin(run.heading);
  Eigen::Matrix3d R;  // n to lateral, vertical, longitudinal
  R << -s, c, 0.0, 0.0, 0.0, 1.0, c, s, 0.0;
  RunErrors errors;
  std::size_t i = first;
  for (const double place : places) {
    while (i + 1 < recording.imu.size() && recording.distance[i] < place - 1e-9) ++i;
    const auto& p = points[i - first];
    errors.error.push_back(R * geodesy::wgs84.ned_difference(recording.truth[i], p.position));
    errors.covariance.push_back(R * p.position_covariance.matrix() * R.transpose());
  }
  return errors;
}

fusion::Directions predicted_at(const std::vector<fusion::ProfilePoint>& profile, double distance) {
  auto nearest = profile.front();
  for (const auto& p : profile) {
    if (std::abs(p.distance - distance) < std::abs(nearest.distance - distance)) nearest = p;
  }
  return nearest.sigma;
}

MonteCarloResult summarise(const std::vector<RunErrors>& runs, const std::vector<double>& places, std::size_t middle,
                           const fusion::PlanCase& plan) {
  MonteCarloResult result;
  result.middle = places[middle];
  const auto chain = fusion::chain_accuracy(plan, 0.0);
  Eigen::Array3d inside = Eigen::Array3d::Zero();
  const auto n = static_cast<double>(runs.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    Eigen::Array3d squares = Eigen::Array3d::Zero();
    for (const auto& run : runs) {
      const Eigen::Array3d e = run.error[k].array();
      squares += e.square();
      inside += (e.abs() < 1.96 * run.covariance[k].diagonal().array().sqrt()).cast<double>();
    }
    const Eigen::Array3d rms = (squares / n).sqrt();
    result.profile.push_back({places[k], {rms[0], rms[1], rms[2]}, predicted_at(chain.profile, places[k])});
  }
  for (const auto& run : runs) {
    const Eigen::Vector3d& e = run.error[middle];
    result.lateral.push_back(e[0]);
    result.vertical.push_back(e[1]);
    result.longitudinal.push_back(e[2]);
    result.nees += e.dot(run.covariance[middle].llt().solve(e)) / n;
  }
  result.rms = result.profile[middle].rms;
  result.predicted = result.profile[middle].predicted;
  inside /= n * static_cast<double>(places.size());
  result.coverage = {inside[0], inside[1], inside[2]};
  return result;
}

}  // namespace

Expected<MonteCarloResult> run_monte_carlo(const MonteCarloSetup& setup, Progress& progress) {
  const simulation::StraightRun run = straight_run(setup);
  const fusion::LandmarkOptions options = filter_options(setup);
  std::vector<double> places;
  for (int k = 0; k <= places_per_interval * setup.plan.intervals; ++k) {
    places.push_back(setup.plan.spacing * k / places_per_interval);
  }
  const auto middle =
      static_cast<std::size_t>(places_per_interval * (setup.plan.intervals / 2) + places_per_interval / 2);

  std::vector<RunErrors> errors(static_cast<std::size_t>(setup.runs));
  std::vector<std::optional<Error>> failures(errors.size());
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stop{false};
  std::mutex reporting;
  const int cores = tbb::info::default_concurrency();
  tbb::task_arena arena(setup.threads > 0 ? std::min(setup.threads, cores) : cores);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, errors.size(), [&](std::size_t i) {
      if (stop) return;
      auto result = one_run(setup, run, options, simulation::run_seed(setup.seed, i), places);
      if (result) {
        errors[i] = std::move(*result);
      } else {
        failures[i] = result.error();
        stop = true;
      }
      const std::size_t count = ++done;
      const std::unique_lock lock(reporting, std::try_to_lock);
      if (!lock) return;
      progress.report("Monte Carlo", static_cast<double>(count) / static_cast<double>(errors.size()));
      if (progress.cancelled()) stop = true;
    });
  });
  for (std::size_t i = 0; i < failures.size(); ++i) {
    if (!failures[i]) continue;
    Error error = *failures[i];
    error.field = fmt::format("Monte Carlo run {}: {}", i, error.field);
    return fail(std::move(error));
  }
  if (stop) return fail({.found = "cancelled"});
  return summarise(errors, places, middle, setup.plan);
}

}  // namespace versine::app
