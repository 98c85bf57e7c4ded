// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pointings.hpp"

/// Several rounds of a station made one.
namespace versine::stationing {

/// Brings every set to the first one, whatever the circle was turned by in between.
void turn_sets(Grouped& g);

/// Least squares in two ways (points, sets), by alternation: sets may hold different points.
void adjust_sets(Grouped& g);

/// Removes pointings of a point that lie far from the median of its sets; returns how many readings.
std::size_t drop_outliers(Grouped& g, std::size_t i, const Instrument& instrument);

}  // namespace versine::stationing
