// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/track/compute.hpp"

namespace versine::track {

/// What the fastenings of a slab track can do to one rail in one direction.
struct FasteningOptions {
  double step = 1e-3;              ///< of shims or wedges, m
  double lowest = -5e-3;           ///< most negative movement of a fastening, m
  double highest = 5e-3;           ///< m
  double deviation_limit = 10e-3;  ///< left from design, m
  double difference_limit = 1e-3;  ///< left between both rails (gauge or cross level against design), m
  double neighbour_limit = 2e-3;   ///< of movements of neighbouring fastenings, m: the rail bends
  std::vector<ChordCheck> checks = {{"30m", 30.0, 15.0, 5.0}};
  std::vector<double> check_limits = {2e-3};  ///< m, one for each check
  double window = 40.0;                       ///< solved at once, m; half of it is kept, then the next
  double seconds = 0.5;                       ///< of search in one window, processor time; the best found is kept
};

/// Movements of one rail in whole steps, a fastening at a time.
struct FasteningPlan {
  std::vector<int> steps;       ///< positive right or up
  std::vector<double> after;    ///< predicted deviation from design, m
  std::size_t moved = 0;        ///< fastenings with a step
  std::size_t unreachable = 0;  ///< limits that are not met: they are as well as possible
  std::size_t windows = 0;      ///< solved
  std::size_t proven = 0;       ///< windows whose plan is the best there is
  /// Of the other windows: at most this share of their cost (fastenings moved, and a hundred for a step over a limit)
  /// could be spared. 0 when all are proven.
  double gap = 0.0;
};

/// Fewest fastenings moved, then least total movement, so that all limits hold: a mixed-integer linear program (Cbc) in
/// sliding windows, each with its own time to search, so that a line of n metres takes n / (window / 2) times `seconds`
/// at most. `position`: of the fastenings along the track, increasing, m; `deviation`: of the rail there, m, NaN where
/// unknown (it does not move and is no part of a limit). `other_after`: what is left of the rail adjusted before, whose
/// difference is limited too; empty for the first rail. Chords end between fastenings on the line between them. Fails
/// when options contradict each other.
[[nodiscard]] Expected<FasteningPlan> plan_fastenings(std::span<const double> position,
                                                      std::span<const double> deviation,
                                                      const FasteningOptions& options,
                                                      std::span<const double> other_after = {});

}  // namespace versine::track
