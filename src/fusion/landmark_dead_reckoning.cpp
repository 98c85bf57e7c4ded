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

/// Whether the track turns enough for an error of the aligned heading to change the equivalent biases.
bool turns(const std::vector<Stretch>& stretches) {
  constexpr double enough = 0.02;  // rad
  return std::any_of(stretches.begin(), stretches.end(), [&](const Stretch& s) { return s.heading_range > enough; });
}

/// Dead reckoning with its roll and how it lies on the landmarks.
struct Laid {
  Reckoning reckoning;
  std::vector<filter::SmoothedEpoch<roll::size>> roll;
  Placement placed;
  double turned = 0.0;  ///< rad, what was added to the aligned heading before the placement
};

/// Roll and placement for the attitudes that the nodes have.
void lay(Laid& laid, const LandmarkInput& in, const std::vector<std::size_t>& usable, const StaticStart& start,
         const Prior& prior, const LandmarkOptions& o) {
  const DrivingNoise noise = noise_of(o);
  const auto& nodes = laid.reckoning.nodes;
  std::vector<RollTie> ties;
  for (const std::size_t i : usable) {
    const auto& l = (*in.landmarks)[i];
    const std::size_t k = node_at(nodes, l.time);
    if (k == 0) continue;
    if (const auto tie = roll_tie(*in.imu, l, nodes[k], k, o)) ties.push_back(*tie);
  }
  laid.roll = smooth_roll(nodes, prior, noise, ties, o.smoother);
  laid.placed = place(laid.reckoning, in, usable, start, prior, noise, laid.roll, laid.turned, o);
}

/// Where the track turns, the nodes are laid a second time with the heading that the landmarks have found, so that
/// Earth rate and gyro bias are shared out right.
Expected<Laid> reckon_and_lay(const LandmarkInput& in, const std::vector<std::size_t>& usable, StaticStart& start,
                              const LandmarkOptions& o, Progress& progress) {
  std::vector<Time> stops;
  for (const std::size_t i : usable) stops.push_back((*in.landmarks)[i].time);
  const geodesy::Geodetic& place_at = (*in.landmarks)[0].position;
  auto reckoning = reckon(*in.imu, *in.odometer, start, place_at, stops, o, progress);
  if (!reckoning) return tl::unexpected(reckoning.error());
  progress.report("landmarks", 0.0);
  const Prior prior = prior_of(start, o);
  Laid laid{.reckoning = std::move(*reckoning)};
  lay(laid, in, usable, start, prior, o);
  if (!turns(laid.placed.stretches)) return laid;
  laid.turned = laid.placed.heading;
  start = with_heading(start, laid.turned, laid.placed.heading_sigma);
  restart(laid.reckoning.nodes, start, place_at, o);
  lay(laid, in, usable, start, prior, o);
  return laid;
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
  auto laid = reckon_and_lay(input, *usable, *start, options, progress);
  if (!laid) return tl::unexpected(laid.error());
  const Reckoning& reckoning = laid->reckoning;
  const Placement& placed = laid->placed;
  if (auto ok = report_landmarks(input, placed, options, solution.record); !ok) return tl::unexpected(ok.error());
  progress.report("smoothing", 0.0);
  const Smoothed smoothed = smooth(placed.channels, placed.ties, placed.fits, std::move(laid->roll), options.smoother);
  if (progress.cancelled()) return fail({.found = "cancelled"});

  result.heading_correction = laid->turned + placed.heading;
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
  solution.smoothed = corrected_trajectory(reckoning, *input.imu, smoothed, placed.heading, placed.scale, options);
  solution.smoothed.scale = input.imu->scale;
  progress.report("trajectory", 1.0);
  return result;
}

}  // namespace versine::fusion
