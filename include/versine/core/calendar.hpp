// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "versine/core/time.hpp"

/// Between calendar and integer time. UTC here has no room for the leap second itself: 23:59:60 is 00:00:00.
namespace versine {

inline constexpr Duration one_second{1'000'000'000};
inline constexpr Duration one_day{86'400 * one_second.ns};
inline constexpr Duration one_week{7 * one_day.ns};
inline constexpr Duration gps_epoch_in_utc{315'964'800 * one_second.ns};  ///< 1980-01-06 counted from 1970-01-01

/// GPS time minus UTC at a UTC time, whole seconds: 0 in 1980, 18 since 2017-01-01 (IERS Bulletin C 52; no leap second
/// has been announced since).
[[nodiscard]] Duration gps_minus_utc(Time utc);
[[nodiscard]] Time gps_from_utc(Time utc);
[[nodiscard]] Time utc_from_gps(Time gps);

/// GPS time of a week (full count since 1980) and the time in it.
[[nodiscard]] constexpr Time gps_time(int week, Duration in_week) {
  return {week * one_week.ns + in_week.ns};
}

/// Midnight of "2025-07-08" or "2025/07/08", counted from 1970-01-01 without leap seconds; nothing if it is no date.
[[nodiscard]] std::optional<Time> parse_date(std::string_view text);
/// The time in a day of "19:34:18.499" (to the nanosecond; seconds may be left out); nothing if it is no such time.
[[nodiscard]] std::optional<Duration> parse_time_of_day(std::string_view text);
/// "2025-07-08T19:34:18.499", date and time separated by T, blank or '_', with nothing, Z or +hh:mm behind, counted
/// from 1970-01-01 without leap seconds.
[[nodiscard]] std::optional<Time> parse_date_time(std::string_view text);

/// A decimal number as an exact count of 10^-`digits`, rounded half away from zero behind them; "243261.8540" with 9
/// digits is 243261854000000. Exponents are understood. Advances `text` behind the number; nothing if there is none or
/// it does not fit into 63 bits.
[[nodiscard]] std::optional<std::int64_t> parse_decimal(std::string_view& text, int digits, char point = '.');

/// For a person and for files: "2025-07-08 19:34:18.499" of a GPS or UTC time, "243261.854 s" of a recorder's clock.
[[nodiscard]] std::string to_text(Time time, TimeScale scale);
/// Seconds since the epoch with as many decimals as are needed, at least one, exact: "1436038476.0", "0.005".
[[nodiscard]] std::string seconds_text(Time time);

}  // namespace versine
