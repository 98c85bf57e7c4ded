// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "versine/simulation/random.hpp"

/// Coloured noise as it stands in data sheets, one value a step of fixed length. Each process is in its stationary
/// state from the first step on; the random walk starts at zero.
namespace versine::simulation {

/// First-order Gauss-Markov: autocovariance sigma^2 exp(-|t| / tau), discretised exactly.
class GaussMarkov {
 public:
  /// REQUIRES sigma >= 0, correlation_time > 0, step > 0 (s).
  GaussMarkov(double sigma, double correlation_time, double step, RandomStream& random);
  double next(RandomStream& random);
  [[nodiscard]] double value() const { return value_; }

 private:
  double decay_ = 0.0, drive_ = 0.0, value_ = 0.0;
};

/// Flicker noise, one-sided density B^2 / (pi f): the floor of its Allan deviation is B sqrt(2 ln 2 / pi) = 0.664 B
/// (IEEE Std 952-1997 annex C.1.1). Sum of Gauss-Markov processes, two for each decade of correlation times; within
/// 4 % in density from 1 / (2 pi longest) to a tenth of the sampling rate.
class FlickerNoise {
 public:
  /// `bias_instability` is B, in the unit of the value. REQUIRES longest > step > 0 (s).
  FlickerNoise(double bias_instability, double step, double longest, RandomStream& random);
  double next(RandomStream& random);

 private:
  struct Stage {
    GaussMarkov process;
    int every = 1;  ///< steps for which the value is held: an eighth of the correlation time or less
    int left = 0;
  };
  std::vector<Stage> stages_;
};

/// Random walk of that density, unit/sqrt(s).
class RandomWalk {
 public:
  RandomWalk(double density, double step);
  double next(RandomStream& random);

 private:
  double drive_ = 0.0, value_ = 0.0;
};

}  // namespace versine::simulation
