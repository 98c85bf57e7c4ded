// SPDX-License-Identifier: Apache-2.0
#include "versine/core/calendar.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <chrono>
#include <limits>

namespace versine {

namespace {
namespace chr = std::chrono;

constexpr Time midnight(int year, unsigned month, unsigned day) {
  const chr::sys_days days = chr::year(year) / chr::month(month) / chr::day(day);
  return {days.time_since_epoch().count() * one_day.ns};
}

// Days that began with one leap second more (IERS).
constexpr std::array leap_days{midnight(1981, 7, 1), midnight(1982, 7, 1), midnight(1983, 7, 1), midnight(1985, 7, 1),
                               midnight(1988, 1, 1), midnight(1990, 1, 1), midnight(1991, 1, 1), midnight(1992, 7, 1),
                               midnight(1993, 7, 1), midnight(1994, 7, 1), midnight(1996, 1, 1), midnight(1997, 7, 1),
                               midnight(1999, 1, 1), midnight(2006, 1, 1), midnight(2009, 1, 1), midnight(2012, 7, 1),
                               midnight(2015, 7, 1), midnight(2017, 1, 1)};

// A whole number of exactly `width` digits at the front of `text`, taken off it.
std::optional<int> digits(std::string_view& text, std::size_t least, std::size_t most) {
  std::size_t n = 0;
  int value = 0;
  while (n < text.size() && n < most && text[n] >= '0' && text[n] <= '9') value = 10 * value + (text[n++] - '0');
  if (n < least) return std::nullopt;
  text.remove_prefix(n);
  return value;
}

bool take(std::string_view& text, std::string_view any_of) {
  if (text.empty() || any_of.find(text.front()) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

std::optional<Time> take_date(std::string_view& text) {
  const auto year = digits(text, 4, 4);
  if (!year || !take(text, "-/")) return std::nullopt;
  const auto month = digits(text, 1, 2);
  if (!month || !take(text, "-/")) return std::nullopt;
  const auto day = digits(text, 1, 2);
  if (!day) return std::nullopt;
  const chr::year_month_day date{chr::year(*year), chr::month(static_cast<unsigned>(*month)),
                                 chr::day(static_cast<unsigned>(*day))};
  if (!date.ok() || *year < 1900 || *year > 2200) return std::nullopt;
  return Time{chr::sys_days(date).time_since_epoch().count() * one_day.ns};
}

std::optional<Duration> take_time_of_day(std::string_view& text) {
  const auto hour = digits(text, 1, 2);
  if (!hour || *hour > 24 || !take(text, ":")) return std::nullopt;
  const auto minute = digits(text, 2, 2);
  if (!minute || *minute > 59) return std::nullopt;
  std::int64_t ns = 0;
  if (take(text, ":")) {
    if (text.empty() || text.front() < '0' || text.front() > '9') return std::nullopt;
    const auto second = parse_decimal(text, 9);
    if (!second || *second >= 61 * one_second.ns) return std::nullopt;
    ns = *second;
  }
  return Duration{(*hour * 3600 + *minute * 60) * one_second.ns + ns};
}

// Value of the digits before and behind the point, and how many stand behind.
struct Decimal {
  std::int64_t mantissa = 0;
  int behind = 0;
  bool any = false, fits = true;
};

Decimal take_digits(std::string_view& text, char point) {
  Decimal d;
  bool after_point = false;
  for (; !text.empty(); text.remove_prefix(1)) {
    const char c = text.front();
    if (c == point && !after_point) {
      after_point = true;
      continue;
    }
    if (c < '0' || c > '9') break;
    d.any = true;
    if (d.mantissa > (std::numeric_limits<std::int64_t>::max() - 9) / 10) {
      if (!after_point) d.fits = false;  // digits behind the point beyond the 18th do not matter
      continue;
    }
    d.mantissa = 10 * d.mantissa + (c - '0');
    if (after_point) ++d.behind;
  }
  return d;
}

int take_exponent(std::string_view& text) {
  if (text.size() < 2 || (text[0] != 'e' && text[0] != 'E')) return 0;
  std::string_view rest = text.substr(1);
  const bool negative = rest.front() == '-';
  if (rest.front() == '-' || rest.front() == '+') rest.remove_prefix(1);
  const auto value = digits(rest, 1, 3);
  if (!value) return 0;
  text = rest;
  return negative ? -*value : *value;
}
}  // namespace

std::optional<std::int64_t> parse_decimal(std::string_view& text, int digits_wanted, char point) {
  const bool negative = !text.empty() && text.front() == '-';
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  const Decimal d = take_digits(text, point);
  if (!d.any || !d.fits) return std::nullopt;
  int shift = digits_wanted - d.behind + take_exponent(text);
  std::int64_t value = d.mantissa;
  for (; shift > 0 && value != 0; --shift) {
    if (value > std::numeric_limits<std::int64_t>::max() / 10) return std::nullopt;
    value *= 10;
  }
  if (shift < -18) value = 0;
  if (shift < 0 && value != 0) {
    std::int64_t divisor = 1;
    for (; shift < 0; ++shift) divisor *= 10;
    value = value / divisor + (value % divisor >= divisor - divisor / 2 ? 1 : 0);
  }
  return negative ? -value : value;
}

Duration gps_minus_utc(Time utc) {
  std::int64_t seconds = 0;
  for (const Time day : leap_days) seconds += utc >= day ? 1 : 0;
  return {seconds * one_second.ns};
}

Time gps_from_utc(Time utc) {
  return utc - gps_epoch_in_utc + gps_minus_utc(utc);
}

Time utc_from_gps(Time gps) {
  const Time without = gps + gps_epoch_in_utc;
  // The count steps at a UTC midnight, so the difference is looked up at the UTC time it leads to.
  const Time guess = without - gps_minus_utc(without);
  return without - gps_minus_utc(guess);
}

std::optional<Time> parse_date(std::string_view text) {
  const auto date = take_date(text);
  return text.empty() ? date : std::nullopt;
}

std::optional<Duration> parse_time_of_day(std::string_view text) {
  const auto time = take_time_of_day(text);
  return text.empty() ? time : std::nullopt;
}

std::optional<Time> parse_date_time(std::string_view text) {
  const auto date = take_date(text);
  if (!date || !take(text, "T _t")) return std::nullopt;
  const auto time = take_time_of_day(text);
  if (!time) return std::nullopt;
  Duration zone;
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) {
    const bool west = text.front() == '-';
    text.remove_prefix(1);
    const auto hours = digits(text, 2, 2);
    take(text, ":");
    const auto minutes = text.empty() ? std::optional(0) : digits(text, 2, 2);
    if (!hours || !minutes) return std::nullopt;
    zone.ns = (*hours * 3600 + *minutes * 60) * one_second.ns * (west ? -1 : 1);
  } else {
    take(text, "Zz");
  }
  if (!text.empty()) return std::nullopt;
  return *date + *time - zone;
}

std::string seconds_text(Time time) {
  const bool negative = time.ns < 0;
  const auto magnitude = negative ? 0ull - static_cast<std::uint64_t>(time.ns) : static_cast<std::uint64_t>(time.ns);
  std::string text =
      fmt::format("{}{}.{:09}", negative ? "-" : "", magnitude / 1'000'000'000, magnitude % 1'000'000'000);
  while (text.back() == '0' && text[text.size() - 2] != '.') text.pop_back();
  return text;
}

std::string to_text(Time time, TimeScale scale) {
  if (scale == TimeScale::recorder) return seconds_text(time) + " s";
  const Time since_1970 = scale == TimeScale::gps ? time + gps_epoch_in_utc : time;
  const chr::sys_time<chr::nanoseconds> point{chr::nanoseconds(since_1970.ns)};
  const auto day = chr::floor<chr::days>(point);
  const chr::year_month_day date(day);
  const std::int64_t ns = (point - day).count();
  const std::int64_t s = ns / one_second.ns;
  std::string text = fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02}", int(date.year()), unsigned(date.month()),
                                 unsigned(date.day()), s / 3600, s / 60 % 60, s % 60);
  if (const std::int64_t ms = ns % one_second.ns / 1'000'000; ms != 0) text += fmt::format(".{:03}", ms);
  return text;
}

}  // namespace versine
