// SPDX-License-Identifier: Apache-2.0
#include "versine/app/compare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::app {

namespace {

struct Collector {
  std::vector<double> magnitude;
  std::size_t covered = 0;
  double normalised = 0.0;

  void add(double difference, double variance) {
    magnitude.push_back(std::abs(difference));
    if (std::abs(difference) <= 1.96 * std::sqrt(variance)) ++covered;
    normalised += difference * difference / variance;
  }
  DifferenceStatistics statistics() {
    DifferenceStatistics out;
    const auto n = static_cast<double>(magnitude.size());
    double sum = 0.0;
    for (const double x : magnitude) sum += x * x;
    std::sort(magnitude.begin(), magnitude.end());
    out.rms = std::sqrt(sum / n);
    out.p95 = magnitude[static_cast<std::size_t>(0.95 * (n - 1.0))];
    out.max = magnitude.back();
    out.coverage = static_cast<double>(covered) / n;
    out.in_sigmas = std::sqrt(normalised / n);
    return out;
  }
};

}  // namespace

Expected<TrajectoryComparison> compare_trajectories(const geodesy::Trajectory& trajectory,
                                                    const geodesy::Trajectory& reference, double margin) {
  std::array<Collector, 6> c;
  const Duration edge = Duration::from_seconds(margin);
  for (const auto& r : reference) {
    if (trajectory.empty() || r.time < trajectory.front().time + edge || r.time + edge > trajectory.back().time)
      continue;
    const std::size_t i = trajectory.lower_bound(r.time);
    const bool exact = trajectory[i].time == r.time;
    if (i == 0 && !exact) continue;
    const auto &a = exact ? trajectory[i] : trajectory[i - 1], &b = trajectory[i];
    const double dt = (b.time - a.time).seconds();
    if (a.segment != b.segment || dt > 1.0) continue;
    const double f = dt > 0.0 ? (r.time - a.time).seconds() / dt : 0.0;
    // Hermite: the velocities bend the path between two points, which at 1 Hz is worth centimetres.
    const Eigen::Vector3d chord = geodesy::wgs84.ned_difference(a.position, b.position);
    const Eigen::Vector3d bend = f * (1 - f) * ((1 - f) * (dt * a.v_eb_n - chord) - f * (dt * b.v_eb_n - chord));
    const Eigen::Vector3d error = f * chord + bend - geodesy::wgs84.ned_difference(a.position, r.position);
    const geodesy::Euler attitude = geodesy::to_euler(r.q_nb);
    const double heading = r.v_eb_n.head<2>().norm() > 0.1 ? std::atan2(r.v_eb_n.y(), r.v_eb_n.x()) : attitude.yaw;
    Eigen::Matrix3d axes;
    axes << std::cos(heading), std::sin(heading), 0.0, -std::sin(heading), std::cos(heading), 0.0, 0.0, 0.0, -1.0;
    const Eigen::Matrix3d P = (f < 0.5 ? a : b).position_covariance.matrix() + r.position_covariance.matrix();
    const Eigen::Vector3d local = axes * error;
    const Eigen::Matrix3d P_local = axes * P * axes.transpose();
    for (int k = 0; k < 3; ++k) c[static_cast<std::size_t>(k)].add(local(k), P_local(k, k));

    // The phi-angle between the two attitudes, seen in the reference's heading: roll, pitch, heading errors.
    const Eigen::Quaterniond q = a.q_nb.slerp(f, b.q_nb);
    const Eigen::Vector3d phi_n = geodesy::to_rotation_vector(q * r.q_nb.conjugate());
    Eigen::Matrix3d level = Eigen::Matrix3d(Eigen::AngleAxisd(-attitude.yaw, Eigen::Vector3d::UnitZ()));
    const Eigen::Matrix3d A =
        level * ((f < 0.5 ? a : b).attitude_covariance.matrix() + r.attitude_covariance.matrix()) * level.transpose();
    const Eigen::Vector3d phi = level * phi_n;
    for (int k = 0; k < 3; ++k) c[static_cast<std::size_t>(3 + k)].add(phi(k), A(k, k));
  }
  if (c[0].magnitude.empty()) {
    return fail({.found = "two trajectories without a common time",
                 .expected = "runs that overlap in time",
                 .advice = "compare results of the same recording, on the same clock"});
  }
  TrajectoryComparison out;
  out.points = c[0].magnitude.size();
  out.along = c[0].statistics();
  out.across = c[1].statistics();
  out.up = c[2].statistics();
  out.roll = c[3].statistics();
  out.pitch = c[4].statistics();
  out.heading = c[5].statistics();
  return out;
}

}  // namespace versine::app
