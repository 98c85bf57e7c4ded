// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/core/run_record.hpp"
#include "versine/sensors/measurements.hpp"

namespace versine::sensors {

/// An uninterrupted piece of a series: samples `begin` to `end` (one past the last). The first sample of a piece
/// covers the nominal interval before it; nothing is integrated from one piece to the next.
struct Segment {
  std::size_t begin = 0, end = 0;
  [[nodiscard]] std::size_t size() const { return end - begin; }
};

struct ImuCheckOptions {
  std::string file;                  ///< named in errors
  std::size_t max_interpolated = 3;  ///< missing samples in a row that are interpolated; more split the run (Chen 4.1)
  double max_rate = 35.0;            ///< rad/s per axis; 2000 deg/s, the widest range of common gyroscopes
  double max_acceleration = 320.0;   ///< m/s^2 per axis; 32 g
  /// s: all six channels unchanged for longer are a sensor that hangs, unless they came there or go on by two of its
  /// counts at most: a quiet sensor of coarse resolution that stands.
  double stuck_after = 0.25;
  double max_disorder = 0.01;  ///< share of samples out of order above which the file is refused
};

struct CheckedImu {
  ImuSeries series;               ///< increments, strictly increasing times
  std::vector<Segment> segments;  ///< at least one, in order, covering the series
  RunRecord record;
};

/// Integrity check and repair of Chen 2018 section 4.1. Samples with NaN, null specific force, values out of range,
/// hanging values, duplicate or backward times are left out; up to `max_interpolated` missing samples in a row are
/// interpolated; longer gaps split the series into segments. Rates become increments over the actual intervals.
/// Errors: fewer than two good samples, more than `max_disorder` out of order.
[[nodiscard]] Expected<CheckedImu> check_imu(ImuSeries series, const ImuCheckOptions& options = {});

}  // namespace versine::sensors
