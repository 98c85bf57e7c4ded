// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "segment_output.hpp"

namespace versine::fusion::detail {

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
