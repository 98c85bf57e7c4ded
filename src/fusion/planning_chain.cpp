// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/planning_chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace versine::fusion {

namespace {

using namespace landmark;

/// The run as nodes: where each lies, and its channels. Heading is taken as north, so that north is along the track.
struct PlanChain {
  std::vector<double> distance;
  std::vector<VerticalStep> vertical{1};
  std::vector<LevelStep> level{1};
};

double node_step(const PlanCase& plan) {
  return plan.spacing / std::ceil(plan.spacing / 1.25);
}

PlanChain build(const PlanCase& plan) {
  const DrivingNoise noise{
      .random_walk = plan.gyro.random_walk,
      .bias_walk = std::hypot(plan.gyro.bias_instability * std::sqrt(2.0 / plan.gyro.correlation_time),
                              plan.gyro.rate_random_walk),
      .scale_walk = plan.scale_walk,
      .path_walk = plan.path_walk,
      .distance_walk = plan.distance_walk};
  const double step = node_step(plan), r = plan.landmark * plan.landmark;
  const auto add = [&](PlanChain& c, const Motion& motion) {
    c.distance.push_back((c.distance.empty() ? 0.0 : c.distance.back()) + motion.distance);
    c.vertical.push_back(vertical_step(motion, noise));
    c.level.push_back(level_step(motion, noise));
  };
  PlanChain c;
  c.distance.push_back(0.0);
  const auto observe = [&] {
    c.vertical.back().observation = observe_down(0.0, r);
    c.level.back().observation = observe_level(Eigen::Vector2d::Zero(), r * Eigen::Matrix2d::Identity());
  };
  const auto per_interval = static_cast<int>(std::lround(plan.spacing / step));
  for (int i = 0; i < plan.intervals; ++i) {
    for (int k = 0; k < per_interval; ++k) add(c, Motion::straight(step / plan.speed, plan.speed, 0.0));
    observe();
    if (plan.stand > 0.0 && i + 1 < plan.intervals) add(c, Motion::straight(plan.stand, 0.0, 0.0));
  }
  return c;
}

template <int N, int M>
std::vector<filter::SmoothedEpoch<N>> smooth(const filter::Estimate<N>& start,
                                             const std::vector<filter::LinearStep<N, M>>& steps) {
  const std::span<const filter::LinearStep<N, M>> span(steps);
  const auto forward = filter::filter_forward(start, span);
  return filter::smooth_rts(span, std::span<const filter::ForwardEpoch<N, M>>(forward));
}

/// Variance of a weighted sum of one state at ascending nodes, from the chain's gains.
template <int N>
double combined_variance(const std::vector<filter::SmoothedEpoch<N>>& epochs, int state,
                         const std::vector<std::pair<std::size_t, double>>& terms) {
  double sum = 0.0;
  for (std::size_t a = 0; a < terms.size(); ++a) {
    // Row of cov(e_a, e_k) as k moves on to each later term.
    Eigen::Matrix<double, 1, N> row = Eigen::Matrix<double, 1, N>::Unit(N, state);
    sum += terms[a].second * terms[a].second * epochs[terms[a].first].estimate.covariance(state, state);
    std::size_t k = terms[a].first;
    for (std::size_t b = a + 1; b < terms.size(); ++b) {
      for (; k < terms[b].first; ++k) row = (row * epochs[k].gain).eval();
      sum += 2.0 * terms[a].second * terms[b].second * row.dot(epochs[k].estimate.covariance.col(state));
    }
  }
  return sum;
}

/// Largest sigma of a figure made of (distance from its start, weight) terms, moved along the run.
template <int N>
double worst_figure(const std::vector<filter::SmoothedEpoch<N>>& epochs, const std::vector<double>& distance, int state,
                    const std::vector<std::pair<double, double>>& figure) {
  double worst = 0.0;
  const auto node = [&](double d) {
    const auto it = std::lower_bound(distance.begin(), distance.end(), d - 1e-6);
    return static_cast<std::size_t>(it - distance.begin());
  };
  for (double s = 0.0; s + figure.back().first <= distance.back() + 1e-6; s += 1.25) {
    std::vector<std::pair<std::size_t, double>> terms;
    for (const auto& [d, weight] : figure) terms.emplace_back(std::min(node(s + d), epochs.size() - 1), weight);
    worst = std::max(worst, combined_variance(epochs, state, terms));
  }
  return std::sqrt(worst);
}

void enlarge(Directions& worst, const Directions& d) {
  worst = {std::max(worst.lateral, d.lateral), std::max(worst.vertical, d.vertical),
           std::max(worst.longitudinal, d.longitudinal)};
}

}  // namespace

DerivedErrors derive(const PlanCase& p) {
  DerivedErrors d;
  d.heading_error = gyrocompass_heading_error(p.gyro.bias, p.latitude);
  d.bias = equivalent_bias(p.gyro.bias, p.level, d.heading_error, p.latitude, p.heading);
  d.vertical = {p.landmark, p.landmark, p.level, d.bias.lateral, p.gyro.random_walk};
  d.lateral = {p.landmark, p.landmark, d.heading_error, d.bias.vertical, p.gyro.random_walk};
  d.longitudinal = {p.landmark, p.landmark, p.scale, p.scale_walk};
  return d;
}

Directions closed_form_sigma(const PlanCase& plan, double distance) {
  const DerivedErrors d = derive(plan);
  const double T = plan.spacing / plan.speed, t = distance / plan.speed;
  return {std::sqrt(cross_variance(d.lateral, plan.speed, T, t)),
          std::sqrt(cross_variance(d.vertical, plan.speed, T, t)),
          std::sqrt(longitudinal_variance(d.longitudinal, plan.speed, T, t))};
}

Directions closed_form_worst(const PlanCase& plan) {
  Directions worst;
  constexpr int parts = 40;
  for (int i = 0; i <= parts; ++i) enlarge(worst, closed_form_sigma(plan, plan.spacing * i / parts));
  return worst;
}

ChainAccuracy chain_accuracy(const PlanCase& plan, double chord) {
  const DerivedErrors d = derive(plan);
  const PlanChain chain = build(plan);
  VerticalEstimate v0;
  v0.covariance.diagonal() << plan.landmark, d.vertical.angle, d.vertical.bias;
  v0.covariance.diagonal() = v0.covariance.diagonal().cwiseAbs2().eval();
  LevelEstimate l0;
  l0.covariance.diagonal() << plan.landmark, plan.landmark, plan.scale, d.lateral.angle, d.lateral.bias;
  l0.covariance.diagonal() = l0.covariance.diagonal().cwiseAbs2().eval();
  const auto vertical = smooth(v0, chain.vertical);
  const auto level = smooth(l0, chain.level);

  ChainAccuracy a;
  const double middle = plan.spacing * (plan.intervals / 2);
  for (std::size_t k = 0; k < chain.distance.size(); ++k) {
    const auto& P = level[k].estimate.covariance;
    const Directions sigma{std::sqrt(P(level::east, level::east)), std::sqrt(vertical[k].estimate.covariance(0, 0)),
                           std::sqrt(P(level::north, level::north))};
    a.profile.push_back({chain.distance[k], sigma});
    enlarge(a.worst, sigma);
    if (chain.distance[k] >= middle - 1e-6 && chain.distance[k] <= middle + plan.spacing + 1e-6) {
      enlarge(a.worst_interior, sigma);
    }
  }
  if (chord > 0.0 && chord <= chain.distance.back()) {
    const std::vector<std::pair<double, double>> versine{{0.0, -0.5}, {0.5 * chord, 1.0}, {chord, -0.5}};
    a.versine = {worst_figure(level, chain.distance, level::east, versine),
                 worst_figure(vertical, chain.distance, vertical::position, versine), 0.0};
    // d30 = (e25 - e33) + (8/48)(e49 - e1), steps of 0.625 m.
    const std::vector<std::pair<double, double>> check{
        {0.0, -8.0 / 48.0}, {15.0, 1.0}, {20.0, -1.0}, {30.0, 8.0 / 48.0}};
    a.short_wave = {worst_figure(level, chain.distance, level::east, check),
                    worst_figure(vertical, chain.distance, vertical::position, check), 0.0};
  }
  return a;
}

}  // namespace versine::fusion
