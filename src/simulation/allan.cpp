// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/allan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace versine::simulation {

std::vector<AllanPoint> allan_deviation(std::span<const double> increments, double interval, int per_decade) {
  const std::size_t n = increments.size();
  // Sums lose digits when the mean is large against the noise: take it out first.
  double mean = 0.0;
  for (const double x : increments) mean += x;
  mean /= std::max<double>(1.0, static_cast<double>(n));
  std::vector<double> angle(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) angle[i + 1] = angle[i] + (increments[i] - mean);

  std::vector<AllanPoint> curve;
  std::size_t last = 0;
  for (int k = 0;; ++k) {
    const auto m = static_cast<std::size_t>(std::llround(std::pow(10.0, static_cast<double>(k) / per_decade)));
    if (4 * m > n) break;
    if (m == last) continue;
    last = m;
    double sum = 0.0;
    const std::size_t terms = n + 1 - 2 * m;
    for (std::size_t i = 0; i < terms; ++i) {
      const double d = angle[i + 2 * m] - 2.0 * angle[i + m] + angle[i];
      sum += d * d;
    }
    const double tau = static_cast<double>(m) * interval;
    curve.push_back({tau, std::sqrt(sum / (2.0 * static_cast<double>(terms))) / tau, terms});
  }
  return curve;
}

double random_walk_of(std::span<const AllanPoint> curve, double from, double to) {
  double sum = 0.0, weights = 0.0;
  for (const AllanPoint& p : curve) {
    if (p.tau < from || p.tau > to) continue;
    const double weight = 1.0 / p.tau;  // independent averages in the same length
    sum += weight * p.deviation * p.deviation * p.tau;
    weights += weight;
  }
  return weights > 0.0 ? std::sqrt(sum / weights) : 0.0;
}

double bias_instability_of(std::span<const AllanPoint> curve, double total_time, double least_independent) {
  double lowest = 0.0;
  for (const AllanPoint& p : curve) {
    if (total_time / p.tau < least_independent) continue;
    if (lowest == 0.0 || p.deviation < lowest) lowest = p.deviation;
  }
  return lowest / std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi);
}

}  // namespace versine::simulation
