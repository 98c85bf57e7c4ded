// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <span>
#include <string_view>

namespace versine::simulation {

/// One stream of random numbers, fixed by a seed and a name: "imu.gyro.x" draws the same numbers whatever other
/// sensors the scenario has, on any number of threads. Reproducible to the bit on the same machine.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  /// Normal with mean 0 and sigma 1.
  double normal();
  Eigen::Vector3d normal3() { return {normal(), normal(), normal()}; }
  void fill_normal(std::span<double> out);
  /// Uniform on [from, to).
  double uniform(double from = 0.0, double to = 1.0);
  /// Exponential with that mean: the waiting time of a Poisson process.
  double exponential(double mean);
  /// True with that probability.
  bool chance(double probability) { return uniform() < probability; }

 private:
  std::mt19937_64 engine_;
};

/// Seed of run `run` of a Monte Carlo set: run 0 is the scenario's own seed.
[[nodiscard]] std::uint64_t run_seed(std::uint64_t seed, std::uint64_t run);

}  // namespace versine::simulation
