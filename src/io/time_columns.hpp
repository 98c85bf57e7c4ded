// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "versine/core/calendar.hpp"
#include "versine/io/table_reader.hpp"

namespace versine::io {

/// Applies a clock's offset and drift, counted from its first stamp.
class ClockCorrection {
 public:
  explicit ClockCorrection(const Clock& clock)
      : offset_(Duration::from_seconds(clock.offset_s)), drift_(clock.drift_ppm * 1e-6) {}
  Time operator()(Time read) {
    if (!first_) first_ = read;
    const Duration drift{std::llround(drift_ * static_cast<double>((read - *first_).ns))};
    return read + offset_ + drift;
  }

 private:
  Duration offset_;
  double drift_;
  std::optional<Time> first_;
};

/// Follows a count that starts again at 0 every `period`: a fall by more than half of it is the next turn.
class RollOver {
 public:
  explicit RollOver(Duration period) : period_(period) {}
  Duration operator()(Duration in_period) {
    if (last_ && in_period.ns - last_->ns < -period_.ns / 2) turns_.ns += period_.ns;
    if (last_ && in_period.ns - last_->ns > period_.ns / 2 && turns_.ns > 0) {
      return in_period + turns_ - period_;  // a straggler of the turn before
    }
    last_ = in_period;
    return in_period + turns_;
  }

 private:
  Duration period_, turns_;
  std::optional<Duration> last_;
};

/// The columns of a table that make its time: time_s, _ms, _us, _ns; gps_week with tow_s; tow_s; time_of_day_s with a
/// date; or a text such as 2025-07-08T19:34:18.499.
class TimeColumns {
 public:
  /// `base` is "time", or "time_from" and the like. An Error when the table has no time, or an incomplete one.
  [[nodiscard]] static Expected<TimeColumns> bind(TableReader& table, const Clock& clock,
                                                  const std::string& base = "time");
  /// Of the present row; nothing when the field is empty.
  [[nodiscard]] Expected<std::optional<Time>> read(const TableReader& table);
  /// Of the series: known once a row has been read.
  [[nodiscard]] TimeScale scale() const { return scale_; }

 private:
  enum class Form { seconds, week, week_and_seconds, day, text };
  explicit TimeColumns(const Clock& clock) : clock_(clock), correction_(clock), scale_(clock.scale) {}
  [[nodiscard]] Time in_series_scale(Time t) const;

  Clock clock_;
  ClockCorrection correction_;
  TimeScale scale_;
  Form form_ = Form::seconds;
  TableReader::Slot slot_ = 0, week_ = 0;
  RollOver roll_over_{one_week};
  Time base_;
  bool first_ = true;
};

}  // namespace versine::io
