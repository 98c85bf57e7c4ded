// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/landmark_dead_reckoning.hpp"

#include <algorithm>
#include <cmath>

#include "landmark_checks.hpp"
#include "landmark_placement.hpp"
#include "landmark_report.hpp"
#include "versine/fusion/landmark_output.hpp"

namespace versine::fusion {

namespace {

using namespace landmark;

Prior prior_of(const StaticStart& start, const LandmarkOptions& o) {
  constexpr double position = 10.0;  // m: the landmarks decide
  return {.position = position,
          .scale = o.scale_sigma,
          .pitch = start.pitch_sigma,
          .heading = start.heading_sigma,
          .bias = start.bias_sigma,
          .roll = start.roll_sigma};
}

DrivingNoise noise_of(const LandmarkOptions& o) {
  const auto& gyro = o.gyro;
  return {
      .random_walk = gyro.random_walk,
      .bias_walk = std::hypot(gyro.bias_instability * std::sqrt(2.0 / gyro.correlation_time), gyro.rate_random_walk),
      .scale_walk = o.scale_walk,
      .path_walk = o.path_walk,
      .distance_walk = o.distance_walk};
}

/// Dead reckoning, roll and placement from one start.
struct Pass {
  Reckoning reckoning;
  std::vector<filter::SmoothedEpoch<roll::size>> roll;
  Placement placed;
};

/// `turned`: what earlier passes have added to the heading of the alignment.
Expected<Pass> run_pass(const LandmarkInput& in, const std::vector<std::size_t>& usable, const StaticStart& start,
                        const Prior& prior, const DrivingNoise& noise, double turned, const LandmarkOptions& o,
                        Progress& progress) {
  std::vector<Time> stops;
  for (const std::size_t i : usable) stops.push_back((*in.landmarks)[i].time);
  auto reckoning = reckon(*in.imu, *in.odometer, start, (*in.landmarks)[0].position, stops, o, progress);
  if (!reckoning) return tl::unexpected(reckoning.error());
  progress.report("landmarks", 0.0);
  std::vector<RollTie> ties;
  for (const std::size_t i : usable) {
    const auto& l = (*in.landmarks)[i];
    const std::size_t k = node_at(reckoning->nodes, l.time);
    if (k == 0) continue;
    if (const auto tie = roll_tie(*in.imu, l, reckoning->nodes[k], k, o)) ties.push_back(*tie);
  }
  Pass pass{.reckoning = std::move(*reckoning)};
  pass.roll = smooth_roll(pass.reckoning.nodes, prior, noise, ties, o.smoother);
  pass.placed = place(pass.reckoning, in, usable, start, prior, noise, pass.roll, turned, o);
  return pass;
}

/// Whether the track turns enough for an error of the aligned heading to change the equivalent biases.
bool turns(const std::vector<Stretch>& stretches) {
  constexpr double enough = 0.02;  // rad
  return std::any_of(stretches.begin(), stretches.end(), [&](const Stretch& s) { return s.heading_range > enough; });
}

/// One pass; where the track turns, a second one with the heading that the landmarks have found, so that Earth rate
/// and gyro bias are shared out right. `turned` takes what the first pass found.
Expected<Pass> run_passes(const LandmarkInput& in, const std::vector<std::size_t>& usable, StaticStart& start,
                          const LandmarkOptions& o, double& turned, Progress& progress) {
  const Prior prior = prior_of(start, o);
  const DrivingNoise noise = noise_of(o);
  auto pass = run_pass(in, usable, start, prior, noise, 0.0, o, progress);
  if (!pass || !turns(pass->placed.stretches)) return pass;
  turned = pass->placed.heading;
  start = with_heading(start, turned, pass->placed.heading_sigma);
  return run_pass(in, usable, start, prior, noise, turned, o, progress);
}

/// What became of each landmark, and its innovation.
void collect_landmarks(const LandmarkInput& in, const Placement& placed, const Smoothed& smoothed,
                       LandmarkSolution& result) {
  for (std::size_t i = 0; i < placed.ties.size(); ++i) {
    const Tie& tie = placed.ties[i];
    const auto& l = (*in.landmarks)[tie.landmark];
    const auto& v = smoothed.vertical[tie.node].estimate.mean;
    const auto& h = smoothed.level[tie.node].estimate.mean;
    result.landmarks.push_back(
        {l.name, l.time, tie.misclosure - Eigen::Vector3d(h(level::north), h(level::east), v(vertical::position)),
         placed.fits[i]});
    const auto& innovation = smoothed.innovations[i];
    result.solution.innovations.push_back({l.time, "landmark", innovation.value.cast<float>(),
                                           innovation.sigma.cast<float>(), innovation.nis, placed.fits[i].used});
  }
}

}  // namespace

Expected<LandmarkSolution> run_landmark_dead_reckoning(const LandmarkInput& input, const LandmarkOptions& options,
                                                       Progress& progress) {
  if (auto ok = check_input(input, options); !ok) return tl::unexpected(ok.error());
  auto start = static_start(*input.imu, *input.odometer, (*input.landmarks)[0].position, options);
  if (!start) return tl::unexpected(start.error());

  LandmarkSolution result;
  Solution& solution = result.solution;
  const Time begin = (*input.imu)[start->sample].time;
  const auto usable = usable_landmarks(input, options, begin, solution.record);
  if (!usable) return tl::unexpected(usable.error());
  const Prior prior = prior_of(*start, options);
  auto pass = run_passes(input, *usable, *start, options, result.heading_correction, progress);
  if (!pass) return tl::unexpected(pass.error());
  auto& reckoning = pass->reckoning;
  const Placement& placed = pass->placed;
  if (auto ok = report_landmarks(input, placed, options, solution.record); !ok) return tl::unexpected(ok.error());
  progress.report("smoothing", 0.0);
  const Smoothed smoothed = smooth(placed.channels, placed.ties, placed.fits, std::move(pass->roll), options.smoother);
  if (progress.cancelled()) return fail({.found = "cancelled"});

  result.heading_correction += placed.heading;
  result.stretches = placed.stretches;
  result.observability = observability_of(reckoning.nodes, placed.channels, placed.ties, placed.fits, prior, smoothed);
  note_observability(result.observability, begin, input.imu->back().time, solution.record);
  warn_model(placed.stretches, options, solution.record);
  collect_landmarks(input, placed, smoothed, result);

  solution.error_names = sensor_error_names();
  const Eigen::Vector3d bias_v = geodesy::to_matrix(options.mounting) * start->rate_bias;
  solution.sensor_errors = sensor_errors(reckoning.nodes, smoothed, bias_v, placed.scale, 1.0);
  if (options.chain_interval > 0.0) {
    solution.chain = error_chain(reckoning.nodes, smoothed, placed.heading, options.chain_interval);
  }
  progress.report("trajectory", 0.0);
  solution.smoothed = corrected_trajectory(std::move(reckoning), smoothed, placed.heading, placed.scale, options);
  solution.smoothed.scale = input.imu->scale;
  progress.report("trajectory", 1.0);
  return result;
}

}  // namespace versine::fusion
