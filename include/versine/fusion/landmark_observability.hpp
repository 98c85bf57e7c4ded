// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>

#include "versine/fusion/landmark_adjustment.hpp"

namespace versine::fusion::landmark {

/// How well one state can be told apart in this run.
struct StateVerdict {
  std::string name;
  double before = 0.0;  ///< sigma before the run (the prior), in the state's unit
  double after = 0.0;   ///< largest smoothed sigma in the run
  double gain = 0.0;    ///< before / after; below 2 the landmarks say little about it
  double at = 0.0;      ///< m travelled from the start to where `after` is reached
};

/// Observability of the two channels. `rank` and `condition` of eq. 26 hold for motion at the run's mean speed and
/// heading; `run_rank` and `run_condition` for the landmarks, ways and turns of the actual run. Both matrices are in
/// units of landmark sigma and prior sigma, so that a condition says something.
struct Observability {
  int vertical_rank = 0, level_rank = 0;
  double vertical_condition = 0.0, level_condition = 0.0;
  int run_vertical_rank = 0, run_level_rank = 0;
  double run_vertical_condition = 0.0, run_level_condition = 0.0;
  std::vector<StateVerdict> states;
  std::vector<std::string> verdict;  ///< plain sentences: what is determined, what is weak and where
};

/// Rank and condition of eq. 26 alone, for a speed and heading; `interval` (s) scales the time derivatives.
[[nodiscard]] Observability observability_at(double speed, double heading, double interval, const Prior& prior,
                                             double landmark_sigma);

/// The whole, for a run.
[[nodiscard]] Observability observability_of(std::span<const Node> nodes, const Channels& channels,
                                             std::span<const Tie> ties, std::span<const Fit> fits, const Prior& prior,
                                             const Smoothed& smoothed);

}  // namespace versine::fusion::landmark
