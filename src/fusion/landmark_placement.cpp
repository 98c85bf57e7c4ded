// SPDX-License-Identifier: Apache-2.0
#include "landmark_placement.hpp"

#include <algorithm>
#include <cmath>

#include "versine/geodesy/ellipsoid.hpp"

namespace versine::fusion::landmark {

namespace {

// rad and 1: what a further round would change by less than 0.01 mm a landmark
constexpr double settled = 2e-5;
constexpr int most_rounds = 6;

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
  return tie;
}

}  // namespace

std::size_t node_at(const std::vector<Node>& nodes, Time t) {
  const auto it = std::lower_bound(nodes.begin(), nodes.end(), t, [](const Node& n, Time x) { return n.time < x; });
  if (it == nodes.end()) return nodes.size() - 1;
  const auto k = static_cast<std::size_t>(it - nodes.begin());
  return k > 0 && t - nodes[k - 1].time < nodes[k].time - t ? k - 1 : k;
}

std::optional<RollTie> roll_tie(const sensors::ImuSeries& imu, const sensors::LandmarkSample& l, const Node& node,
                                std::size_t k, const LandmarkOptions& o) {
  if (!(l.to - l.from > Duration::from_seconds(2.0))) return std::nullopt;
  Eigen::Vector3d dvel = Eigen::Vector3d::Zero();
  const auto samples = imu.between(l.from, l.to);
  for (const auto& s : samples) dvel += s.dvel;
  const Eigen::Vector3d f = geodesy::to_matrix(o.mounting) * dvel / std::max((l.to - l.from).seconds(), 1e-3);
  if (!(std::abs(f.norm() - 9.81) < 0.3)) return std::nullopt;
  const geodesy::Euler reckoned = geodesy::to_euler(node.q_nv);
  const double roll = std::atan2(-f.y(), -f.z());
  constexpr double noise = 1e-5;  // rad: accelerometer noise and the trolley's rocking over seconds
  return RollTie{k, geodesy::wrap_pi(roll - reckoned.roll), noise * noise};
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
    if (std::abs(turn) < settled && std::abs(stretch) < settled && round > 0) break;
    if (round + 1 == most_rounds) break;
    p.heading += turn;
    p.scale += stretch;
    anchor = 0;
    while (anchor + 1 < p.fits.size() && !p.fits[anchor].used) ++anchor;
  }
  return p;
}

}  // namespace versine::fusion::landmark
