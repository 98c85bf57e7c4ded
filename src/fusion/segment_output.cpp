// SPDX-License-Identifier: Apache-2.0
#include "segment_output.hpp"

namespace versine::fusion::detail {

namespace {
geodesy::Covariance3 between(const geodesy::Covariance3& a, const geodesy::Covariance3& b, double share) {
  const auto mix = [w = static_cast<float>(share)](float x, float y) { return x + w * (y - x); };
  return {mix(a.xx, b.xx), mix(a.yy, b.yy), mix(a.zz, b.zz), mix(a.xy, b.xy), mix(a.xz, b.xz), mix(a.yz, b.yz)};
}
}  // namespace

void write_trajectory(const RunContext& c, const Segment& segment, const std::deque<Waypoint>& waypoints,
                      const std::vector<Node>& nodes, std::int32_t number, geodesy::Trajectory& out) {
  const double rate = c.options.output_rate;
  const auto tick_of = [&](Time t) {
    return rate > 0.0 ? static_cast<std::int64_t>(std::floor(static_cast<double>(t.ns) * (rate * 1e-9) + 1e-6)) : t.ns;
  };
  // Reserved at once: a vector that grows by doubling would need half as much again at its peak.
  const double points = (segment.to - segment.from).seconds() * rate + 2.0;
  const std::size_t samples = segment.end - segment.begin;
  out.samples.reserve(out.size() + (rate > 0.0 ? std::min(samples, static_cast<std::size_t>(points)) : samples));
  std::int64_t last = INT64_MIN;
  const auto point = [&](const inertial::NavState& nav, std::size_t k, double share) {
    const Node &a = nodes[k], &b = nodes[std::min(k + 1, nodes.size() - 1)];
    const Eigen::Matrix<double, 9, 1> x =
        share > 0.0 ? Eigen::Matrix<double, 9, 1>(a.after + share * (b.before - a.after)) : a.after;
    geodesy::TrajectoryPoint p;
    p.time = nav.time;
    p.position = geodesy::wgs84.displaced(nav.position, -x.head<3>());
    p.v_eb_n = nav.v_eb_n - x.segment<3>(3);
    p.q_nb = geodesy::from_rotation_vector(x.tail<3>()) * nav.q_nb;
    p.position_covariance = between(a.position, b.position, share);
    p.velocity_covariance = between(a.velocity, b.velocity, share);
    p.attitude_covariance = between(a.attitude, b.attitude, share);
    p.segment = number;
    out.samples.push_back(p);
  };
  for (std::size_t k = 0; k + 1 < waypoints.size(); ++k) {
    const Time begin = waypoints[k].estimate.nav.time, end = waypoints[k + 1].estimate.nav.time;
    inertial::NavState nav = waypoints[k].estimate.nav;
    Eigen::Matrix3d C_nb = nav.q_nb.toRotationMatrix();
    ImuWalk walk(c.input.imu, segment.begin, std::max(segment.begin, waypoints[k].next_sample));
    walk.advance(nav, C_nb, waypoints[k].estimate.imu, end, waypoints[k + 1].held,
                 [&](const inertial::StepGeometry&, const inertial::Increment&, const inertial::NavState& now) {
                   if (now.time == end) return;
                   if (const std::int64_t t = tick_of(now.time); t != last) {
                     last = t;
                     point(now, k, (now.time - begin).seconds() / (end - begin).seconds());
                   }
                 });
    // At a step's end: the estimate after its updates. Ends between samples are measurements' times, not output times.
    const std::size_t sample = waypoints[k + 1].next_sample;
    const bool on_sample = sample > 0 && c.input.imu[sample - 1].time == end;
    if (const std::int64_t t = tick_of(end); on_sample && t != last) {
      last = t;
      point(waypoints[k + 1].estimate.nav, k + 1, 0.0);
    }
  }
}

Eigen::VectorXf parameter_values(const InsEstimate& e, const InsLayout& l) {
  Eigen::VectorXf v = Eigen::VectorXf::Zero(l.size());
  const auto set = [&v](auto block, const auto& value) {
    if (block.enabled()) v.segment<decltype(block)::size>(block.offset) = value.template cast<float>();
  };
  set(l.gyro_bias, e.imu.gyro_bias);
  set(l.accelerometer_bias, e.imu.accelerometer_bias);
  set(l.gyro_scale, e.imu.gyro_scale);
  set(l.accelerometer_scale, e.imu.accelerometer_scale);
  v[l.odometer_scale.offset] = static_cast<float>(e.odometer_scale);
  if (l.mounting.enabled()) {
    const geodesy::Euler m = geodesy::to_euler(e.C_vb);
    v[l.mounting.offset] = static_cast<float>(m.pitch);
    v[l.mounting.offset + 1] = static_cast<float>(m.yaw);
  }
  set(l.gnss_lever, e.gnss_lever);
  set(l.wheel_lever, e.wheel_lever);
  set(l.gnss_bias, e.gnss_bias);
  set(l.landmark_position, e.landmark_error.head<3>());
  set(l.landmark_attitude, e.landmark_error.tail<3>());
  return v.tail(l.size() - l.moving());
}

std::vector<int> chain_order(int n) {
  std::vector<int> order{0, 1, 2, 6, 7, 8, 3, 4, 5};
  for (int i = 9; i < n; ++i) order.push_back(i);
  return order;
}

}  // namespace versine::fusion::detail
