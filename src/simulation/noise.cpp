// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace versine::simulation {

GaussMarkov::GaussMarkov(double sigma, double correlation_time, double step, RandomStream& random)
    : decay_(std::exp(-step / correlation_time)),
      drive_(sigma * std::sqrt(-std::expm1(-2.0 * step / correlation_time))),
      value_(sigma == 0.0 ? 0.0 : sigma * random.normal()) {}

double GaussMarkov::next(RandomStream& random) {
  if (drive_ != 0.0) value_ = decay_ * value_ + drive_ * random.normal();
  return value_;
}

FlickerNoise::FlickerNoise(double bias_instability, double step, double longest, RandomStream& random) {
  if (bias_instability == 0.0) return;
  // Equal variances at correlation times in the ratio r: the densities 4 sigma^2 tau / (1 + (2 pi f tau)^2) sum to
  // sigma^2 / (f ln r); equal to B^2 / (pi f).
  const double log_ratio = 0.5 * std::numbers::ln10;
  const double sigma = bias_instability * std::sqrt(log_ratio / std::numbers::pi);
  // One stage beyond both ends keeps the sum straight up to them.
  for (double tau = longest * std::exp(log_ratio); tau > 0.5 * step; tau *= std::exp(-log_ratio)) {
    const int every = std::max(1, static_cast<int>(tau / (8.0 * step)));
    stages_.push_back({GaussMarkov(sigma, tau, step * every, random), every, 0});
    // Stages start to be renewed at different steps, or all long ones would jump together.
    stages_.back().left = static_cast<int>(random.uniform() * every);
  }
}

double FlickerNoise::next(RandomStream& random) {
  double sum = 0.0;
  for (Stage& stage : stages_) {
    if (--stage.left < 0) {
      stage.process.next(random);
      stage.left = stage.every - 1;
    }
    sum += stage.process.value();
  }
  return sum;
}

RandomWalk::RandomWalk(double density, double step) : drive_(density * std::sqrt(step)) {}

double RandomWalk::next(RandomStream& random) {
  if (drive_ != 0.0) value_ += drive_ * random.normal();
  return value_;
}

}  // namespace versine::simulation
