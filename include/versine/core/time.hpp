// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <compare>
#include <cstdint>

namespace versine {

/// What a Time counts from. A series states it once; times of different scales are never mixed.
enum class TimeScale {
  gps,       ///< GPS time, from 1980-01-06 00:00:00 (week and seconds of week, no leap seconds)
  utc,       ///< UTC without leap seconds in the count, from 1970-01-01 00:00:00 (as POSIX)
  recorder,  ///< the recorder's own clock, from whatever it counts from
};

/// A span of time, integer nanoseconds; sums and differences are exact.
struct Duration {
  std::int64_t ns = 0;

  [[nodiscard]] constexpr double seconds() const { return 1e-9 * static_cast<double>(ns); }
  [[nodiscard]] static Duration from_seconds(double s) { return {static_cast<std::int64_t>(std::llround(s * 1e9))}; }
  constexpr auto operator<=>(const Duration&) const = default;
};

/// A point in time, integer nanoseconds since the epoch of its series' TimeScale; range +-292 years.
/// A `double` of Unix seconds resolves 0.24 us, which costs 48 m in ten minutes of pure inertial navigation; that is
/// why a difference is formed in integers before it becomes a `double`.
struct Time {
  std::int64_t ns = 0;

  /// Seconds since the epoch; for display and for files, never for differences.
  [[nodiscard]] constexpr double seconds() const { return 1e-9 * static_cast<double>(ns); }
  [[nodiscard]] static Time from_seconds(double s) { return {static_cast<std::int64_t>(std::llround(s * 1e9))}; }
  constexpr auto operator<=>(const Time&) const = default;
};

constexpr Duration operator-(Time a, Time b) { return {a.ns - b.ns}; }
constexpr Time operator+(Time t, Duration d) { return {t.ns + d.ns}; }
constexpr Time operator-(Time t, Duration d) { return {t.ns - d.ns}; }
constexpr Duration operator+(Duration a, Duration b) { return {a.ns + b.ns}; }
constexpr Duration operator-(Duration a, Duration b) { return {a.ns - b.ns}; }

}  // namespace versine
