// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/io/line_reader.hpp"
#include "versine/io/read_recording.hpp"

/// The readers of read_recording.hpp on lines from anywhere: for tests and fuzzing.
namespace versine::io {

[[nodiscard]] Expected<Read<sensors::ImuSeries>> read_imu_from(LineReader lines, const ImuFile& file);
[[nodiscard]] Expected<Read<Series<sensors::GnssSample>>> read_gnss_from(LineReader lines, const GnssFile& file);
[[nodiscard]] Expected<Read<Series<sensors::GnssSample>>> read_rtklib(LineReader lines, const GnssFile& file);
[[nodiscard]] Expected<Read<Series<sensors::GnssSample>>> read_nmea(LineReader lines, const GnssFile& file);

}  // namespace versine::io
