// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <numbers>

/// Numbers that every domain writes down.
namespace versine {

/// A value that is not there: not measured, not asked for, or outside its range. Every reader skips or refuses it.
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

inline constexpr double inf = std::numeric_limits<double>::infinity();  ///< also the radius of a straight
inline constexpr double two_pi = 2.0 * std::numbers::pi;

constexpr double square(double x) {
  return x * x;
}

}  // namespace versine
