// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/core/run_record.hpp"
#include "versine/sensors/measurements.hpp"

namespace versine::gnss {

struct AgreementOptions {
  double distance = 0.05;  ///< fixes of both directions that differ by more are doubted, m
  double sigmas = 4.0;     ///< and by more than this many sigmas of the difference
};

/// Forward and backward filters fix their ambiguities from different data; where both fix and disagree, at least one
/// is wrong, and where only one fixes, the other's float solution may contradict it. Such epochs of `combined` lose
/// their fix (they become float_ambiguity) and get the difference as sigma, so that the navigation filter's gates see
/// them for what they are. Findings tell where.
struct Agreement {
  Series<sensors::GnssSample> series;
  std::size_t fixed = 0;      ///< of `combined`, before
  std::size_t confirmed = 0;  ///< fixed alike in both directions
  std::size_t doubted = 0;
  std::vector<Finding> findings;
};
[[nodiscard]] Agreement compare_directions(Series<sensors::GnssSample> combined,
                                           const Series<sensors::GnssSample>& forward,
                                           const Series<sensors::GnssSample>& backward,
                                           const AgreementOptions& options);

}  // namespace versine::gnss
