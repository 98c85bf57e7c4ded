// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include "io/read_from.hpp"

/// The text readers as functions of any bytes: a crash, an error without words, or a number that is not finite, is a
/// find.
namespace versine::fuzz {

inline void demand(bool holds) {
  if (!holds) std::abort();
}

inline void imu(const std::string& text) {
  const auto read = io::read_imu_from(io::LineReader::from_text(text), {});
  if (!read) return demand(!read.error().found.empty());
  for (const auto& s : read->series) demand(s.dtheta.allFinite() && s.dvel.allFinite());
}

template <io::GnssFile::Format format>
void gnss(const std::string& text) {
  io::GnssFile file;
  file.format = format;
  file.sigma_horizontal = file.sigma_vertical = file.sigma_velocity = 1.0;
  const auto read = io::read_gnss_from(io::LineReader::from_text(text), file);
  if (!read) return demand(!read.error().found.empty());
  for (const auto& s : read->series) {
    demand(std::isfinite(s.position.latitude + s.position.longitude + s.position.height));
    demand(s.sigma_ned.minCoeff() > 0.0);
  }
}

inline constexpr std::array<std::pair<const char*, void (*)(const std::string&)>, 4> readers{
    {{"imu", imu},
     {"gnss", gnss<io::GnssFile::Format::csv>},
     {"nmea", gnss<io::GnssFile::Format::nmea>},
     {"rtklib", gnss<io::GnssFile::Format::rtklib>}}};

}  // namespace versine::fuzz
