// SPDX-License-Identifier: Apache-2.0
#include "time_columns.hpp"

#include <fmt/format.h>

#include <cmath>

namespace versine::io {

Expected<TimeColumns> TimeColumns::bind(TableReader& table, const Clock& clock, const std::string& base) {
  TimeColumns columns(clock);
  const auto tow = base == "time" ? table.find_time("tow") : Expected<std::optional<TableReader::Slot>>(std::nullopt);
  if (!tow) return tl::unexpected(tow.error());
  if (*tow) {
    columns.slot_ = **tow;
    for (const char* name : {"gps_week", "week"}) {
      const auto week = table.find(name, Quantity::none);
      if (week && *week) {
        columns.week_ = **week;
        columns.form_ = Form::week_and_seconds;
        return columns;
      }
    }
    columns.form_ = Form::week;
    if (clock.gps_week) {
      columns.base_ = gps_time(*clock.gps_week, {});
    } else {
      columns.scale_ = columns.clock_.scale = TimeScale::recorder;  // seconds of an unknown week
    }
    return columns;
  }
  if (base == "time" && table.has("time_of_day")) {
    const auto slot = table.find_time("time_of_day");
    if (!slot) return tl::unexpected(slot.error());
    const auto date = parse_date(clock.date);
    if (!date) {
      return fail({.file = table.name(),
                   .field = "date",
                   .found = clock.date.empty() ? "a time of day and no date" : "'" + clock.date + "'",
                   .expected = "the date of the first sample",
                   .advice = "set date = \"2025-07-08\" beside the file"});
    }
    columns.form_ = Form::day;
    columns.slot_ = **slot;
    columns.roll_over_ = RollOver(one_day);
    columns.base_ = *date;
    return columns;
  }
  for (const std::string& name : {base + "_utc", base + "_iso", std::string("timestamp"), std::string("datetime")}) {
    if (!table.has(name) || (base != "time" && !name.starts_with(base))) continue;
    columns.form_ = Form::text;
    columns.slot_ = *table.find_text(name);
    if (name.ends_with("_utc")) columns.clock_.scale = columns.scale_ = TimeScale::utc;
    return columns;
  }
  const auto seconds = table.find_time(base);
  if (!seconds) return tl::unexpected(seconds.error());
  if (*seconds) {
    columns.slot_ = **seconds;
    return columns;
  }
  const auto missing = table.need(base, Quantity::time);  // for its message
  return tl::unexpected(missing.error());
}

Time TimeColumns::in_series_scale(Time t) const {
  return clock_.scale == TimeScale::utc ? gps_from_utc(t) : t;
}

Expected<std::optional<Time>> TimeColumns::read(const TableReader& table) {
  Time t;
  if (form_ == Form::text) {
    const auto text = table.text(slot_);
    if (text.empty()) return std::optional<Time>();
    auto parsed = parse_date_time(text);
    if (!parsed) {
      return fail(table.complaint(slot_, fmt::format("'{}'", text.substr(0, 40)),
                                  "a time such as 2025-07-08T19:34:18.499",
                                  "correct or delete the line; when the column is another one, correct [columns]"));
    }
    if (clock_.scale == TimeScale::gps) *parsed = *parsed - gps_epoch_in_utc;
    t = *parsed;
  } else {
    const std::int64_t ns = table.nanoseconds(slot_);
    if (ns == TableReader::missing) return std::optional<Time>();
    t = {ns};
    if (form_ == Form::seconds) {
      // GPS and UTC seconds have ten digits; a small count is the recorder's own, whatever was declared.
      constexpr std::int64_t too_small = 100'000'000 * one_second.ns;
      if (first_ && ns < too_small) clock_.scale = TimeScale::recorder;
    } else if (form_ == Form::week_and_seconds) {
      const double week = table.number(week_);
      if (!(week >= 0.0 && week < 10000.0)) return std::optional<Time>();
      t = gps_time(static_cast<int>(week), {ns});
    } else {
      t = base_ + roll_over_(Duration{ns});
      if (form_ == Form::day && clock_.scale == TimeScale::gps) t = t - gps_epoch_in_utc;
    }
  }
  first_ = false;
  scale_ = clock_.scale == TimeScale::recorder ? TimeScale::recorder : TimeScale::gps;
  return std::optional<Time>(correction_(in_series_scale(t)));
}

}  // namespace versine::io
