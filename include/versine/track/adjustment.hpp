// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/track/compute.hpp"

namespace versine::track {

/// What tamping may do to one direction (lateral: slew; vertical: lift).
struct AdjustmentOptions {
  double spacing = 2.5;     ///< between the points that are solved for, m; a multiple of the grid's step
  double smallest = -0.03;  ///< most negative movement, m; 0 for lifts
  double largest = 0.03;    ///< m
  double ramp = 1e-3;       ///< change of movement per metre of track: run-in and run-out
  double run_in = 20.0;     ///< at both ends the movement starts from 0; within this length the checks do not count, m
  std::vector<ChordCheck> checks = {{"30m", 30.0, 15.0, 5.0}, {"300m", 300.0, 15.0, 150.0}};
  std::vector<double> check_limits = {2e-3, 10e-3};  ///< m, one for each check
  double design_weight = 0.2;                        ///< of one metre left from design, against one metre moved
  double smooth_weight = 2.0;  ///< of bends left in the result (second differences), against one metre moved
  struct Fixed {
    double from = 0.0, to = 0.0;  ///< mileage, m: bridges, platforms, switches that must not move
  };
  std::vector<Fixed> fixed;
  double window = 600.0;  ///< solved at once, m; windows overlap by half
};

/// Movements and what they lead to, on the grid.
struct Adjustment {
  std::vector<double> mileage;                    ///< m
  std::vector<double> movement;                   ///< m, positive right or up
  std::vector<double> before;                     ///< deviation from design, m
  std::vector<double> after;                      ///< predicted
  std::vector<double> worst_before, worst_after;  ///< of each check, m
  std::size_t unreachable = 0;                    ///< checks that no allowed movement brings within their limit
};

/// Least movement that brings the chord checks within their limits: a linear program (both checks are linear in the
/// deviations, EQUATIONS), minimising |movement| + design_weight |deviation left| + smooth_weight |bends left|, solved
/// by Clp in overlapping windows. Checks that cannot be met are met as well as possible and counted.
/// Missing deviations (NaN) are bridged by zero movement. Fails when options contradict each other.
[[nodiscard]] Expected<Adjustment> plan_adjustment(std::span<const double> mileage, std::span<const double> deviation,
                                                   double step, const AdjustmentOptions& options);

}  // namespace versine::track
