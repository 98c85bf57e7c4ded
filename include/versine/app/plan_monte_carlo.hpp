// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/core/progress.hpp"
#include "versine/fusion/planning_chain.hpp"

/// Planned accuracy put to the test (Jiang 2017 section 6.1): simulated recordings of the planned survey, each
/// processed by the same program that processes real ones.
namespace versine::app {

struct MonteCarloSetup {
  fusion::PlanCase plan;
  sensors::TriadErrors simulated_gyro;  ///< what the recordings get; the filter is told `plan.gyro`
  bool flicker = false;                 ///< simulated bias instability as flicker noise of that B
  double static_start = 0.0;            ///< s of standing alignment; 0: attitude given with the plan's errors
  double rate = 100.0;                  ///< of the IMU, 1/s
  int runs = 500;
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all
};

/// Errors of all runs at one place, m.
struct MonteCarloPlace {
  double distance = 0.0;
  fusion::Directions rms, predicted;
};

struct MonteCarloResult {
  double middle = 0.0;                                  ///< m: the middle of the interval in the middle of the run
  std::vector<double> lateral, vertical, longitudinal;  ///< m, one error a run, there
  fusion::Directions rms;                               ///< m, of these
  fusion::Directions predicted;                         ///< m, by covariance
  fusion::Directions coverage;  ///< share of errors inside 1.96 of the filter's own sigma, at all places
  double nees = 0.0;            ///< mean normalised squared error at the middle; 3 when sigmas are honest
  std::vector<MonteCarloPlace> profile;
};

/// Runs are independent of each other and of the number of threads. Errors: those of the method itself; cancelled.
[[nodiscard]] Expected<MonteCarloResult> run_monte_carlo(const MonteCarloSetup& setup, Progress& progress);

}  // namespace versine::app
