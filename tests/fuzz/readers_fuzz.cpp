// SPDX-License-Identifier: Apache-2.0
// Entry points for libFuzzer, one program a reader. A crash, or a number that is not finite, is a find.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "io/read_from.hpp"

namespace {
using namespace versine;

void demand(bool holds) {
  if (!holds) std::abort();
}

[[maybe_unused]] void imu(io::LineReader lines) {
  const auto read = io::read_imu_from(std::move(lines), {});
  if (!read) return demand(!read.error().found.empty());
  for (const auto& s : read->series) demand(s.dtheta.allFinite() && s.dvel.allFinite());
}

[[maybe_unused]] void gnss(io::LineReader lines, io::GnssFile::Format format) {
  io::GnssFile file;
  file.format = format;
  file.sigma_horizontal = file.sigma_vertical = file.sigma_velocity = 1.0;
  const auto read = io::read_gnss_from(std::move(lines), file);
  if (!read) return demand(!read.error().found.empty());
  for (const auto& s : read->series) {
    demand(std::isfinite(s.position.latitude + s.position.longitude + s.position.height));
    demand(s.sigma_ned.minCoeff() > 0.0);
  }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto lines = io::LineReader::from_text(std::string(reinterpret_cast<const char*>(data), size));
#if defined(VERSINE_FUZZ_imu)
  imu(std::move(lines));
#elif defined(VERSINE_FUZZ_nmea)
  gnss(std::move(lines), io::GnssFile::Format::nmea);
#elif defined(VERSINE_FUZZ_rtklib)
  gnss(std::move(lines), io::GnssFile::Format::rtklib);
#else
  gnss(std::move(lines), io::GnssFile::Format::csv);
#endif
  return 0;
}
