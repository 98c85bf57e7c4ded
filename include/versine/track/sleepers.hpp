// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "versine/track/geometry.hpp"

namespace versine::track {

struct SleeperOptions {
  double smallest_spacing = 0.3;  ///< m; nearer detections are one sleeper or a false one
  double largest_spacing = 1.2;   ///< m; beyond two of these nothing is mended
  double tolerance = 0.25;        ///< of the local spacing, for a detection to be in place
};
struct SleeperResult {
  std::vector<Sleeper> sleepers;  ///< in order of mileage
  std::size_t rejected = 0;       ///< detections between two sleepers
  std::size_t mended = 0;         ///< sleepers that the sensor missed
};

/// Sleepers from the range to the ground (Chen 2018 section 3.6): the range is smaller above a sleeper. The threshold
/// lies between the two heights that the readings cluster around (Otsu, per 50 m), a sleeper's place is the middle of
/// its low stretch. Then the spacing (median of the neighbours) tells which detections are false (too near to both
/// neighbours in place) and where one was missed (a gap of about two or three spacings). `s`: mileages, increasing;
/// NaN ranges are left out.
[[nodiscard]] SleeperResult find_sleepers(std::span<const double> s, std::span<const double> range,
                                          const SleeperOptions& options = {});

}  // namespace versine::track
