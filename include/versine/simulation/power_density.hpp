// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace versine::simulation {

/// One-sided power spectral density of a uniform series, unit^2 * m for a step in m, at the frequencies k / (piece *
/// step), k = 0 to piece / 2: Welch's mean periodogram of half-overlapping pieces under a Hann window. Empty when the
/// series is shorter than one piece. REQUIRES step > 0, an even piece > 0.
[[nodiscard]] std::vector<double> power_density(std::span<const double> series, double step, std::size_t piece);

}  // namespace versine::simulation
