// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace versine::design {

/// A stretch of equally spaced values that one polynomial describes.
struct Segment {
  std::size_t from = 0, to = 0;  ///< samples [from, to)
  bool ramp = false;             ///< described by the higher of the two degrees
  double level = 0.0;            ///< coefficient of the lower degree at the middle: the value, or the slope per sample
};

/// Splits equally spaced values into stretches of a polynomial of degree `degree` or `degree + 1`, with the fewest and
/// best in the sense of the Bayesian information criterion, by dynamic programming (Bellman 1961; Schwarz 1978).
/// Heading against distance: degree 1, since lines and arcs have a straight heading and clothoids a parabola. Heights:
/// degree 1 (gradients and parabolas). Cant: degree 0.
/// `correlation` is how many neighbouring values count as one independent (track irregularities are correlated).
/// The noise is estimated from the values: median of the residuals of local fits over 15 values. Cost: linear in the
/// number of values, a stretch is at most `longest` values.
[[nodiscard]] std::vector<Segment> segment(std::span<const double> values, int degree, double correlation = 3.0,
                                           std::size_t shortest = 3, std::size_t longest = 600);

}  // namespace versine::design
