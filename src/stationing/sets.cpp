// SPDX-License-Identifier: Apache-2.0
#include "sets.hpp"

#include <algorithm>
#include <cmath>

#include "versine/core/numbers.hpp"
#include "versine/geodesy/attitude.hpp"

namespace versine::stationing {

using geodesy::wrap_pi;

void turn_sets(Grouped& g) {
  std::vector<double> first(g.points.size(), nan);
  for (auto& [number, set] : g.sets) {
    std::vector<double> differences;
    double reference = nan;
    for (const auto& [i, p] : set) {
      if (std::isnan(first[i])) continue;
      if (std::isnan(reference)) reference = p.direction - first[i];
      differences.push_back(wrap_pi(p.direction - first[i] - reference));
    }
    const double turn = differences.empty() ? 0.0 : reference + median(differences);
    for (auto& [i, p] : set) {
      p.direction -= turn;
      if (std::isnan(first[i])) first[i] = p.direction;
      p.direction = first[i] + wrap_pi(p.direction - first[i]);
    }
  }
}

void adjust_sets(Grouped& g) {
  if (g.sets.size() < 2) return;
  std::vector<double> mean(g.points.size());
  for (int round = 0; round < 10; ++round) {
    std::vector<double> sum(mean.size(), 0.0), count(mean.size(), 0.0);
    for (const auto& [number, set] : g.sets) {
      for (const auto& [i, p] : set) sum[i] += p.direction, count[i] += 1.0;
    }
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = sum[i] / std::max(1.0, count[i]);
    double largest = 0.0;
    for (auto& [number, set] : g.sets) {
      double shift = 0.0;
      for (const auto& [i, p] : set) shift += (p.direction - mean[i]) / static_cast<double>(set.size());
      for (auto& [i, p] : set) p.direction -= shift;
      largest = std::max(largest, std::abs(shift));
    }
    if (largest < 1e-12) break;
  }
}

std::size_t drop_outliers(Grouped& g, std::size_t i, const Instrument& instrument) {
  std::vector<double> r, z, d;
  for (const auto& [number, set] : g.sets) {
    const auto p = set.find(i);
    if (p == set.end()) continue;
    r.push_back(p->second.direction);
    z.push_back(p->second.zenith);
    if (!std::isnan(p->second.distance)) d.push_back(p->second.distance);
  }
  if (r.size() < 3) return 0;
  const double r0 = median(r), z0 = median(z), d0 = median(d);
  const double angle =
      6.0 * std::sqrt(2.0) * std::hypot(instrument.angle_sigma, instrument.target_sigma / std::max(d0, 1.0));
  const double range = 6.0 * (instrument.distance_sigma + 1e-6 * instrument.distance_sigma_ppm * d0);
  std::size_t dropped = 0;
  for (auto& [number, set] : g.sets) {
    const auto it = set.find(i);
    if (it == set.end()) continue;
    const Pointing& p = it->second;
    if (std::abs(p.direction - r0) * std::sin(z0) > angle || std::abs(p.zenith - z0) > angle ||
        std::abs(p.distance - d0) > range) {
      dropped += p.both() ? 2 : 1;
      set.erase(it);
    }
  }
  return dropped;
}

}  // namespace versine::stationing
