// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "run_segment.hpp"

namespace versine::fusion::detail {

/// Error and covariance at a step's end, as much as the output needs.
struct Node {
  Eigen::Matrix<double, 9, 1> after = Eigen::Matrix<double, 9, 1>::Zero(), before = after;
  geodesy::Covariance3 position, velocity, attitude;
};

template <class Matrix>
void set_covariance(Node& node, const Matrix& P) {
  node.position = geodesy::Covariance3::from(P.template block<3, 3>(0, 0));
  node.velocity = geodesy::Covariance3::from(P.template block<3, 3>(3, 3));
  node.attitude = geodesy::Covariance3::from(P.template block<3, 3>(6, 6));
}

inline geodesy::Covariance3 between(const geodesy::Covariance3& a, const geodesy::Covariance3& b, double share) {
  const auto mix = [w = static_cast<float>(share)](float x, float y) { return x + w * (y - x); };
  return {mix(a.xx, b.xx), mix(a.yy, b.yy), mix(a.zz, b.zz), mix(a.xy, b.xy), mix(a.xz, b.xz), mix(a.yz, b.yz)};
}

/// Writes a trajectory at the wanted IMU samples: walks from each waypoint as the filter did and takes off the error,
/// which between two steps runs straight from the one to the other.
inline void write_trajectory(const RunContext& c, const Segment& segment, const std::deque<Waypoint>& waypoints,
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

/// Values of the parameters in the order of their names.
inline Eigen::VectorXf parameter_values(const InsEstimate& e, const InsLayout& l) {
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

/// Position and attitude first, as ErrorChain wants them.
inline std::vector<int> chain_order(int n) {
  std::vector<int> order{0, 1, 2, 6, 7, 8, 3, 4, 5};
  for (int i = 9; i < n; ++i) order.push_back(i);
  return order;
}

template <int N, int M>
bool smooth(const RunContext& c, const Steps& steps, SmootherKind kind, std::vector<Node>& nodes) {
  const int n = c.layout.size();
  const NoiseModel noise(c.options, c.layout);
  std::vector<SensorErrorSample> errors;
  struct Link {
    Time time;
    Eigen::MatrixXf covariance, gain;
  };
  std::vector<Link> links;
  const auto time = [&](std::size_t k) { return steps.waypoints[k].estimate.nav.time; };
  const auto due = [&](std::size_t k, double interval) {
    if (k == 0 || k + 1 == steps.steps.size()) return true;
    const auto bin = [&](std::size_t i) {
      return std::floor(static_cast<double>(time(i).ns) * 1e-9 / interval + 1e-6);
    };
    return bin(k) != bin(k - 1);
  };
  const bool with_chain = c.options.chain_rate > 0.0;
  const auto wanted = [&](std::size_t k) {
    return Wanted{due(k, c.options.sensor_error_interval), with_chain && due(k, 1.0 / c.options.chain_rate)};
  };
  const auto take = [&](std::size_t k, const SmoothedStep<N>& s) {
    Node& node = nodes[k];
    node.after = s.x.template head<9>();
    node.before = s.before.template head<9>();
    set_covariance(node, s.navigation);
    if (wanted(k).variances) {
      const InsEstimate e = without_error(steps.waypoints[k].estimate, c.layout, s.x);
      errors.push_back(
          {time(k), parameter_values(e, c.layout), s.variance.tail(n - M).cwiseSqrt().template cast<float>()});
    }
  };
  const std::vector<int> order = chain_order(n);
  const auto permuted = [&](const filter::StateMatrix<N>& m) {
    Eigen::MatrixXf p(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) p(i, j) = static_cast<float>(m(order[std::size_t(i)], order[std::size_t(j)]));
    }
    return p;
  };
  typename Backward<N, M>::Chain chain;
  if (with_chain) {
    chain = [&](std::size_t k, const filter::StateMatrix<N>& P, const filter::StateMatrix<N>& gain, bool linked) {
      links.push_back({time(k), permuted(P), linked ? permuted(gain) : Eigen::MatrixXf()});
    };
  }
  Backward<N, M> backward(steps, noise, n);
  const auto done = kind == SmootherKind::bryson_frazier ? backward.bryson_frazier(wanted, take, chain)
                                                         : backward.rauch_tung_striebel(wanted, take, chain);
  if (!done) return false;
  Solution& solution = c.result.solution;
  solution.sensor_errors.insert(solution.sensor_errors.end(), errors.rbegin(), errors.rend());
  for (auto it = links.rbegin(); it != links.rend(); ++it) {
    solution.chain.push_back(it->time, std::move(it->covariance), std::move(it->gain));
  }
  return true;
}

template <int N, int M>
geodesy::TrajectoryPoint point_of(const Forward<N, M>& forward, std::int32_t number) {
  const inertial::NavState& nav = forward.estimate().nav;
  Node node;
  set_covariance(node, forward.covariance());
  return {nav.time, nav.position, nav.v_eb_n, nav.q_nb, node.position, node.velocity, node.attitude, number};
}

template <int N, int M>
Expected<Previous> run_segment(const RunContext& c, const Segment& segment, const Start& start, std::int32_t number) {
  const int n = c.layout.size();
  Steps steps;
  SegmentStart report{segment.from, segment.to, start.alignment, {}, {}};
  Forward<N, M> forward(c.input, c.options, c.layout, c.standstills, c.judge);
  const bool done = forward.run(segment, start, steps, report, [&](double fraction) {
    c.progress.report("forward pass", fraction);
    if (c.watch != nullptr) c.watch->forward(point_of(forward, number), c.result);
    return !c.progress.cancelled();
  });
  if (!done) return fail({.field = "aided INS", .found = "cancelled"});
  if (!forward.covariance().allFinite() || !forward.estimate().nav.v_eb_n.allFinite()) {
    return fail({.field = "aided INS",
                 .found = "a state that is not a number at the end of the forward pass",
                 .expected = "finite numbers",
                 .advice = "run the integrity checks on the input first"});
  }
  c.result.segments.push_back(report);
  const Previous left{forward.estimate(), forward.covariance()};

  std::vector<Node> nodes(steps.steps.size());
  if (c.options.keep_forward || c.options.smoother == SmootherKind::none) {
    filter::StateMatrix<N> P(n, n);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      unpack<N>(steps.steps[k], P);
      set_covariance(nodes[k], P);
    }
    write_trajectory(c, segment, steps.waypoints, nodes, number, c.result.solution.forward);
  }
  if (c.options.smoother == SmootherKind::none) return left;

  c.progress.report("smoother", 0.0);
  const SmootherKind kind = c.options.smoother;
  if (!smooth<N, M>(c, steps, kind, nodes)) {
    return fail({.field = "smoother",
                 .found = "a covariance that is not positive definite",
                 .expected = "positive variances",
                 .advice = "check for sigmas that are far too small, or run without smoother"});
  }
  c.result.smoother_used = std::max(c.result.smoother_used, kind);
  steps.steps.clear();
  steps.rows.clear();
  steps.arena.clear();
  write_trajectory(c, segment, steps.waypoints, nodes, number, c.result.solution.smoothed);
  return left;
}

}  // namespace versine::fusion::detail
