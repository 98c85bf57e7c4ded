// SPDX-License-Identifier: Apache-2.0
#include "versine/core/calendar.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace versine {
namespace {

std::optional<std::int64_t> decimal(std::string_view text, int digits = 9) {
  const auto value = parse_decimal(text, digits);
  return text.empty() ? value : std::nullopt;
}

TEST(Calendar, DecimalsAreExact) {
  EXPECT_EQ(decimal("243261.8540"), 243261854000000);
  EXPECT_EQ(decimal("1752003258.499000001"), 1752003258499000001);  // a double would lose 190 ns here
  EXPECT_EQ(decimal("-0.5"), -500000000);
  EXPECT_EQ(decimal("+.25"), 250000000);
  EXPECT_EQ(decimal("1.2345e+05"), 123450000000000);
  EXPECT_EQ(decimal("5e-1"), 500000000);
  EXPECT_EQ(decimal("0.0000000005"), 1);
  EXPECT_EQ(decimal("0.00000000049999999999999999999"), 0);
  EXPECT_EQ(decimal("261916", 6), 261916000000);  // milliseconds
  EXPECT_EQ(decimal("123", -1), 12);
  EXPECT_EQ(decimal("1e-30"), 0);
  EXPECT_FALSE(decimal("99999999999"));  // 3170 years
  EXPECT_FALSE(decimal("99999999999999999999"));
  EXPECT_FALSE(decimal(""));
  EXPECT_FALSE(decimal("."));
  EXPECT_FALSE(decimal("12x"));
}

RC_GTEST_PROP(Calendar, SecondsTextRoundTrips, (std::int64_t ns)) {
  std::string text = seconds_text({ns});
  std::string_view view = text;
  RC_PRE(ns != std::numeric_limits<std::int64_t>::min());
  RC_ASSERT(parse_decimal(view, 9) == ns);
}

TEST(Calendar, LeapSeconds) {
  const Time july = *parse_date("2025-07-08");
  EXPECT_EQ(gps_minus_utc(july), Duration{18 * one_second.ns});
  EXPECT_EQ(gps_minus_utc(*parse_date("1980-01-06")), Duration{});
  // Week and time of week of 2025-07-08 19:34:18.499 GPS time, as RTKLIB prints them.
  const Time gps{parse_date_time("2025/07/08 19:34:18.499")->ns - gps_epoch_in_utc.ns};
  EXPECT_EQ(gps, gps_time(2374, Duration{243258'499'000'000}));
  for (const char* day : {"2016-12-31", "2017-01-01", "1999-01-01", "2025-07-08"}) {
    for (const std::int64_t s : {-1, 0, 1, 20, 43200}) {
      const Time utc = *parse_date(day) + Duration{s * one_second.ns};
      EXPECT_EQ(utc_from_gps(gps_from_utc(utc)), utc) << day << " " << s;
    }
  }
}

TEST(Calendar, DatesAndTimes) {
  EXPECT_EQ(parse_date_time("1970-01-01T00:00:00")->ns, 0);
  EXPECT_EQ(parse_date_time("1970-01-01 00:00:00.000000001Z")->ns, 1);
  EXPECT_EQ(parse_date_time("2022-01-14T12:45:25.400+02:00"), parse_date_time("2022-01-14T10:45:25.4"));
  EXPECT_EQ(parse_time_of_day("10:45:27"), parse_time_of_day("10:45:27.000"));
  for (const char* bad : {"2022-13-01T00:00:00", "2022-02-30T00:00:00", "2022-02-28", "22-02-28T00:00:00",
                          "2022-02-28T00:61:00", "2022-02-28T00:00:00x", "2022-02-28T00:00:-1", "T", ""}) {
    EXPECT_FALSE(parse_date_time(bad)) << bad;
  }
  EXPECT_EQ(to_text(gps_time(2374, Duration{243258'499'000'000}), TimeScale::gps), "2025-07-08 19:34:18.499");
  EXPECT_EQ(to_text({-1'500'000'000}, TimeScale::recorder), "-1.5 s");
}

}  // namespace
}  // namespace versine
