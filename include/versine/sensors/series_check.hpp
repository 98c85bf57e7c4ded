// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "versine/core/error.hpp"
#include "versine/core/run_record.hpp"
#include "versine/sensors/measurements.hpp"

namespace versine::sensors {

template <class Sample>
struct Checked {
  Series<Sample> series;  ///< strictly increasing times
  RunRecord record;
};

/// Options of the checks of everything but the IMU.
struct SeriesCheckOptions {
  std::string file;                  ///< named in errors
  double max_disorder = 0.01;        ///< share of samples out of order above which the file is refused
  double stuck_after = 0.0;          ///< s: an unchanged reading for longer is left out; zero: not checked
  double min = -1e300, max = 1e300;  ///< permitted readings, SI; others are left out
  /// Isolated spikes of one-dimensional signals: a reading is replaced by the median of the `window` readings around
  /// it when it is further from that median than `spike` and further than 6 times the window's robust spread. Zero: not
  /// checked.
  double spike = 0.0;
  std::size_t window = 5;
};

/// Leaves out duplicate and backward times, positions that are no place on Earth or exactly 0/0, epochs without fix,
/// and positions that freeze while the velocity says otherwise. A sigma that is not positive is an Error.
[[nodiscard]] Expected<Checked<GnssSample>> check_gnss(Series<GnssSample> series, const SeriesCheckOptions& = {});
/// Spikes of a distance are taken on its increments.
[[nodiscard]] Expected<Checked<OdometerSample>> check_odometer(Series<OdometerSample> series,
                                                               const SeriesCheckOptions& = {});
[[nodiscard]] Expected<Checked<SpeedSample>> check_speed(Series<SpeedSample> series, const SeriesCheckOptions& = {});
[[nodiscard]] Expected<Checked<GaugeSample>> check_gauge(Series<GaugeSample> series, const SeriesCheckOptions& = {});
[[nodiscard]] Expected<Checked<RangeSample>> check_range(Series<RangeSample> series, const SeriesCheckOptions& = {});
[[nodiscard]] Expected<Checked<HeadingSample>> check_heading(Series<HeadingSample> series,
                                                             const SeriesCheckOptions& = {});
[[nodiscard]] Expected<Checked<LandmarkSample>> check_landmarks(Series<LandmarkSample> series,
                                                                const SeriesCheckOptions& = {});

}  // namespace versine::sensors
