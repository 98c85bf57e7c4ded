// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/core/error.hpp"
#include "versine/core/run_record.hpp"
#include "versine/geodesy/trajectory.hpp"
#include "versine/io/recording_description.hpp"
#include "versine/sensors/measurements.hpp"

/// From files to series in SI units, radians and forward-right-down axes. A reader takes what is there: samples may be
/// missing, doubled or out of order; sensors' checks (sensors/*_check.hpp) come next and are needed before any
/// algorithm. What a reader leaves out (lines cut short, fields without a number) it counts in `record`; letters in a
/// number, a missing column, a wrong unit or an empty file are Errors.
namespace versine::io {

template <class Series>
struct Read {
  Series series;
  RunRecord record;
};

[[nodiscard]] Expected<Read<sensors::ImuSeries>> read_imu(const ImuFile& file);
[[nodiscard]] Expected<Read<Series<sensors::GnssSample>>> read_gnss(const GnssFile& file);
[[nodiscard]] Expected<Read<Series<sensors::OdometerSample>>> read_odometer(const OdometerFile& file);
[[nodiscard]] Expected<Read<Series<sensors::SpeedSample>>> read_speed(const SpeedFile& file);
[[nodiscard]] Expected<Read<Series<sensors::GaugeSample>>> read_gauge(const GaugeFile& file);
[[nodiscard]] Expected<Read<Series<sensors::RangeSample>>> read_range(const RangeFile& file);
[[nodiscard]] Expected<Read<Series<sensors::HeadingSample>>> read_heading(const HeadingFile& file);
[[nodiscard]] Expected<Read<Series<sensors::LandmarkSample>>> read_landmarks(const LandmarkFile& file);
[[nodiscard]] Expected<Read<geodesy::Trajectory>> read_trajectory(const TrajectoryFile& file);

}  // namespace versine::io
