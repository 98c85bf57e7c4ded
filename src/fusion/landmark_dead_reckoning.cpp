// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/landmark_dead_reckoning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "versine/fusion/landmark_output.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::fusion {

namespace {

using namespace landmark;

constexpr double position_prior = 10.0;  // m: the landmarks decide
constexpr double settled_heading =
    2e-5;  // rad and 1: what a further round would change by less than 0.01 mm a landmark
constexpr int most_rounds = 6;

Expected<void> check(const LandmarkInput& in, const LandmarkOptions& o) {
  if (in.imu == nullptr || in.imu->size() < 2) {
    return fail({.field = "imu",
                 .found = "no samples",
                 .expected = "gyro increments over the whole run",
                 .advice = "name the IMU's file in the job"});
  }
  if (in.odometer == nullptr || in.odometer->size() < 2) {
    return fail(
        {.field = "odometer",
         .found = "no odometer",
         .expected = "distances over the whole run",
         .advice = "landmark dead reckoning needs an odometer: name its file in the job, or use the aided INS"});
  }
  if (in.landmarks == nullptr || in.landmarks->size() < 2) {
    return fail(
        {.field = "landmarks",
         .found = fmt::format("{} landmarks", in.landmarks == nullptr ? 0 : in.landmarks->size()),
         .expected = "at least two positions at which the trolley stood",
         .advice = "one at each end of the line fixes position, heading and odometer scale; better every 60 m"});
  }
  const double positive[] = {o.gyro.random_walk, o.pitch_sigma,   o.levelling_sigma,
                             o.scale_sigma,      o.node_interval, o.gate};
  for (const double x : positive) {
    if (!(x > 0.0)) {
      return fail({.field = "landmark options",
                   .found = "a standard deviation or interval that is not positive",
                   .expected = "gyro random walk, pitch, levelling, scale, node interval and gate above zero",
                   .advice = "choose a gyro grade, or give each value"});
    }
  }
  for (const auto& l : *in.landmarks) {
    if (!(l.covariance.diagonal().minCoeff() > 0.0)) {
      return fail({.field = "landmarks",
                   .found = fmt::format("landmark '{}' with a sigma that is not positive", l.name),
                   .expected = "a sigma above zero in each direction",
                   .advice = "give the instrument's, such as 0.6 mm"});
    }
  }
  return {};
}

/// The odometer's distance at a time, as the sample at or before it says.
double distance_at(const Series<sensors::OdometerSample>& odometer, Time t) {
  const std::size_t i = odometer.lower_bound(t);
  if (i == odometer.size()) return odometer.back().distance;
  if (i == 0 || odometer[i].time == t) return odometer[i].distance;
  const auto &a = odometer[i - 1], &b = odometer[i];
  return a.distance + (b.distance - a.distance) * (t - a.time).seconds() / (b.time - a.time).seconds();
}

/// Indices of landmarks that lie in the recording and were taken standing. Others are rejected, or an error.
Expected<std::vector<std::size_t>> usable_landmarks(const LandmarkInput& in, const LandmarkOptions& o, Time start,
                                                    RunRecord& record) {
  std::vector<std::size_t> usable;
  Error moving;
  const Time end = std::min(in.imu->back().time, in.odometer->back().time);
  for (std::size_t i = 0; i < in.landmarks->size(); ++i) {
    const auto& l = (*in.landmarks)[i];
    if (l.time < in.imu->front().time || l.time > end) {
      record.rejections.push_back({.sensor = "landmark", .time = l.time, .reason = "outside the recording"});
      continue;
    }
    // Without a standstill given, half a second on either side has to be quiet.
    const Duration half = Duration::from_seconds(0.5);
    const Time from = l.from < l.to ? l.from : l.time - half, to = l.from < l.to ? l.to : l.time + half;
    const double moved = std::abs(distance_at(*in.odometer, to) - distance_at(*in.odometer, from));
    const double since =
        l.time < start ? std::abs(distance_at(*in.odometer, start) - distance_at(*in.odometer, l.time)) : 0.0;
    if (std::max(moved, since) <= o.standing_tolerance) {
      usable.push_back(i);
      continue;
    }
    record.rejections.push_back({.sensor = "landmark", .time = l.time, .reason = "not standing"});
    moving = {.field = "landmarks",
              .found = fmt::format("landmark '{}' at {:.3f} s while the odometer moved {:.1f} mm", l.name,
                                   l.time.seconds(), std::max(moved, since) / units::mm),
              .expected = fmt::format("a trolley that stands to {:.1f} mm", o.standing_tolerance / units::mm),
              .advice =
                  "check the clocks of odometer and total station against each other and the landmark's from and "
                  "to; or leave out landmarks taken in motion (skip_moving_landmarks = true)"};
    if (!o.skip_moving_landmarks) return fail(moving);
  }
  if (usable.size() < 2) {
    if (!moving.found.empty()) return fail(moving);
    return fail({.field = "landmarks",
                 .found = fmt::format("{} of {} landmarks within the recording", usable.size(), in.landmarks->size()),
                 .expected = "at least two",
                 .advice = "check the landmarks' clock and day against the IMU's"});
  }
  return usable;
}

std::size_t node_at(const std::vector<Node>& nodes, Time t) {
  const auto it = std::lower_bound(nodes.begin(), nodes.end(), t, [](const Node& n, Time x) { return n.time < x; });
  if (it == nodes.end()) return nodes.size() - 1;
  const auto k = static_cast<std::size_t>(it - nodes.begin());
  return k > 0 && t - nodes[k - 1].time < nodes[k].time - t ? k - 1 : k;
}

/// Roll by the accelerometers over each standstill at a landmark.
std::vector<RollTie> roll_ties(const sensors::ImuSeries& imu, const sensors::LandmarkSample& l, const Node& node,
                               std::size_t k, const LandmarkOptions& o) {
  if (!(l.to - l.from > Duration::from_seconds(2.0))) return {};
  Eigen::Vector3d dvel = Eigen::Vector3d::Zero();
  const auto samples = imu.between(l.from, l.to);
  for (const auto& s : samples) dvel += s.dvel;
  const Eigen::Vector3d f = geodesy::to_matrix(o.mounting) * dvel / std::max((l.to - l.from).seconds(), 1e-3);
  if (!(std::abs(f.norm() - 9.81) < 0.3)) return {};
  const geodesy::Euler reckoned = geodesy::to_euler(node.q_nv);
  const double roll = std::atan2(-f.y(), -f.z());
  constexpr double noise = 1e-5;  // rad: accelerometer noise and the trolley's rocking over seconds
  return {{k, geodesy::wrap_pi(roll - reckoned.roll), noise * noise}};
}

/// The state of the iteration: how the nominal path lies.
struct Placement {
  double heading = 0.0, scale = 0.0;
  double heading_sigma = 0.0;  ///< rad, at the start, as the landmarks leave it
  std::vector<Tie> ties;
  std::vector<Fit> fits;
  std::vector<Stretch> stretches;
  Channels channels;
};

/// What a landmark's instrument is away from the odometer's point, n-frame, with the attitude as known so far.
Eigen::Vector3d lever_n(const Node& node, double heading, double roll, double pitch, const LandmarkOptions& o) {
  const double yaw = geodesy::to_euler(node.q_nv).yaw + heading, c = std::cos(yaw), s = std::sin(yaw);
  const Eigen::Quaterniond correction =
      geodesy::from_rotation_vector({c * roll - s * pitch, s * roll + c * pitch, 0.0}) *
      Eigen::Quaterniond(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()));
  return correction * (node.q_nv * (geodesy::to_matrix(o.mounting) * (o.lever_landmark - o.lever_odometer)));
}

Tie make_tie(const sensors::LandmarkSample& l, std::size_t index, std::size_t k, const Node& node,
             const Eigen::Vector3d& lever, double heading, const LandmarkOptions& o) {
  Tie tie{.node = k, .landmark = index};
  tie.misclosure = geodesy::wgs84.ned_difference(l.position, geodesy::wgs84.displaced(node.position, lever));
  tie.covariance = l.covariance;
  const double yaw = geodesy::to_euler(node.q_nv).yaw + heading;
  const Eigen::Vector3d along(std::cos(yaw), std::sin(yaw), 0.0);
  tie.covariance += (o.odometer_resolution * o.odometer_resolution / 12.0) * along * along.transpose();
  // Levelling turns a high prism sideways; the channels do not see that.
  const Eigen::Vector3d aside(-along.y(), along.x(), 0.0);
  const double sway = std::abs(lever.z()) * o.levelling_sigma;
  tie.covariance += sway * sway * aside * aside.transpose();
  return tie;
}

Placement place(Reckoning& r, const LandmarkInput& in, const std::vector<std::size_t>& usable, const StaticStart& start,
                const Prior& prior, const DrivingNoise& noise, std::span<const filter::SmoothedEpoch<roll::size>> roll,
                double turned, const LandmarkOptions& o) {
  std::vector<std::size_t> at(usable.size());
  for (std::size_t i = 0; i < usable.size(); ++i) at[i] = node_at(r.nodes, (*in.landmarks)[usable[i]].time);
  ModelErrors errors{.mounting = o.mounting_sigma,
                     .level = start.roll_sigma,
                     .heading = start.heading_sigma,
                     .gyro_scale = o.gyro.scale_factor,
                     .gyro_misalignment = o.gyro.misalignment,
                     .bias = std::hypot(o.gyro.bias_instability, start.bias_sigma),
                     .latitude = (*in.landmarks)[0].position.latitude};
  Placement p;
  std::vector<double> pitch(usable.size(), 0.0);
  const auto lever = [&](std::size_t i) {
    return lever_n(r.nodes[at[i]], p.heading, roll[at[i]].estimate.mean(roll::angle), pitch[i], o);
  };
  std::size_t anchor = 0;
  for (int round = 0; round < most_rounds; ++round) {
    const auto& l = (*in.landmarks)[usable[anchor]];
    const Eigen::Vector3d to_odometer = -lever(anchor);
    place_nodes(r.nodes, p.heading, p.scale, at[anchor], geodesy::wgs84.displaced(l.position, to_odometer));
    p.ties.clear();
    for (std::size_t i = 0; i < usable.size(); ++i) {
      const Node& node = r.nodes[at[i]];
      p.ties.push_back(make_tie((*in.landmarks)[usable[i]], usable[i], at[i], node, lever(i), p.heading, o));
    }
    p.stretches = judge_stretches(r.nodes, at, errors);
    p.channels = build_channels(r.nodes, p.stretches, prior, noise);
    p.channels.level_start.mean(level::heading) = -p.heading - turned;
    p.channels.level_start.mean(level::scale) = -p.scale;
    p.fits = snoop(p.channels, p.ties, o.gate);
    const AtTies smoothed = smooth_at_ties(p.channels, p.ties, p.fits);
    p.heading_sigma = std::sqrt(smoothed.level_start.covariance(level::heading, level::heading));
    const double turn = smoothed.level_start.mean(level::heading), stretch = smoothed.level_start.mean(level::scale);
    for (std::size_t i = 0; i < usable.size(); ++i) pitch[i] = smoothed.vertical[i].estimate.mean(vertical::pitch);
    if (std::abs(turn) < settled_heading && std::abs(stretch) < settled_heading && round > 0) break;
    if (round + 1 == most_rounds) break;
    p.heading += turn;
    p.scale += stretch;
    anchor = 0;
    while (anchor + 1 < p.fits.size() && !p.fits[anchor].used) ++anchor;
  }
  return p;
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
    const auto more = roll_ties(*in.imu, l, reckoning->nodes[k], k, o);
    if (k > 0) ties.insert(ties.end(), more.begin(), more.end());
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

Expected<void> report_landmarks(const LandmarkInput& in, const Placement& p, const LandmarkOptions& o,
                                RunRecord& record) {
  std::size_t used = 0, unchecked = 0;
  for (std::size_t i = 0; i < p.ties.size(); ++i) {
    const auto& l = (*in.landmarks)[p.ties[i].landmark];
    if (p.fits[i].used) {
      ++used;
      unchecked += p.fits[i].redundancy < 0.01 ? 1 : 0;
      continue;
    }
    record.rejections.push_back({.sensor = "landmark",
                                 .time = l.time,
                                 .reason = "contradicts the others",
                                 .normalized = p.fits[i].worst(),
                                 .threshold = o.gate});
  }
  if (used < 2 || 2 * used < p.ties.size()) {
    return fail({.field = "landmarks",
                 .found = fmt::format("{} of {} landmarks that fit each other", used, p.ties.size()),
                 .expected = "most of them, within the sigmas given",
                 .advice =
                     "check coordinate system, height datum, units and lever arm of the landmarks, the odometer's "
                     "scale, a heading given for the start, and whether all sigmas are as small as stated"});
  }
  if (unchecked > 0) {
    record.warnings.push_back(
        fmt::format("{} of {} landmarks are checked by nothing else: an error in one goes into "
                    "the result in full. One more landmark would check them.",
                    unchecked, used));
  }
  return {};
}

void warn_model(const std::vector<Stretch>& stretches, const LandmarkOptions& o, RunRecord& record) {
  std::size_t count = 0;
  const Stretch* worst = nullptr;
  for (const auto& s : stretches) {
    if (!(s.model_error > o.model_error_limit)) continue;
    ++count;
    if (worst == nullptr || s.model_error > worst->model_error) worst = &s;
  }
  if (worst == nullptr) return;
  record.warnings.push_back(fmt::format(
      "the reduced model may be off by more than {:.1f} mm (1 sigma) in {} of {} stretches between landmarks; at worst "
      "{:.2f} mm over {:.0f} m with {:.0f} mrad of cant and {:.1f} deg of turn. Its sigmas include this. Closer "
      "landmarks, better calibrated mounting angles, or the aided INS cure it.",
      o.model_error_limit / units::mm, count, stretches.size(), worst->model_error / units::mm, worst->length,
      worst->cant_range * 1e3, worst->heading_range / units::deg));
}

}  // namespace

Expected<LandmarkSolution> run_landmark_dead_reckoning(const LandmarkInput& input, const LandmarkOptions& options,
                                                       Progress& progress) {
  if (auto ok = check(input, options); !ok) return tl::unexpected(ok.error());
  const geodesy::Geodetic place_at = (*input.landmarks)[0].position;
  auto start = static_start(*input.imu, *input.odometer, place_at, options);
  if (!start) return tl::unexpected(start.error());

  LandmarkSolution result;
  RunRecord& record = result.solution.record;
  const Time begin = (*input.imu)[start->sample].time;
  const auto usable = usable_landmarks(input, options, begin, record);
  if (!usable) return tl::unexpected(usable.error());
  const Prior prior{.position = position_prior,
                    .scale = options.scale_sigma,
                    .pitch = start->pitch_sigma,
                    .heading = start->heading_sigma,
                    .bias = start->bias_sigma,
                    .roll = start->roll_sigma};
  const auto& gyro = options.gyro;
  const DrivingNoise noise{
      .random_walk = gyro.random_walk,
      .bias_walk = std::hypot(gyro.bias_instability * std::sqrt(2.0 / gyro.correlation_time), gyro.rate_random_walk),
      .scale_walk = options.scale_walk,
      .path_walk = options.path_walk,
      .distance_walk = options.distance_walk};
  auto pass = run_pass(input, *usable, *start, prior, noise, 0.0, options, progress);
  if (!pass) return tl::unexpected(pass.error());
  if (turns(pass->placed.stretches)) {
    const double found = pass->placed.heading;
    *start = with_heading(*start, found, pass->placed.heading_sigma);
    pass = run_pass(input, *usable, *start, prior, noise, found, options, progress);
    if (!pass) return tl::unexpected(pass.error());
    result.heading_correction = found;
  }
  auto& reckoning = pass->reckoning;
  const Placement& placed = pass->placed;
  if (auto ok = report_landmarks(input, placed, options, record); !ok) return tl::unexpected(ok.error());
  progress.report("smoothing", 0.0);
  const Smoothed smoothed = smooth(placed.channels, placed.ties, placed.fits, std::move(pass->roll), options.smoother);
  if (progress.cancelled()) return fail({.found = "cancelled"});

  result.observability = observability_of(reckoning.nodes, placed.channels, placed.ties, placed.fits, prior, smoothed);
  result.stretches = placed.stretches;
  result.heading_correction += placed.heading;
  warn_model(placed.stretches, options, record);
  for (std::size_t i = 0; i < placed.ties.size(); ++i) {
    const auto& l = (*input.landmarks)[placed.ties[i].landmark];
    const auto& v = smoothed.vertical[placed.ties[i].node].estimate.mean;
    const auto& h = smoothed.level[placed.ties[i].node].estimate.mean;
    result.landmarks.push_back(
        {l.name, l.time,
         placed.ties[i].misclosure - Eigen::Vector3d(h(level::north), h(level::east), v(vertical::position)),
         placed.fits[i]});
    const auto& in = smoothed.innovations[i];
    result.solution.innovations.push_back(
        {l.time, "landmark", in.value.cast<float>(), in.sigma.cast<float>(), in.nis, placed.fits[i].used});
  }
  Solution& solution = result.solution;
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
