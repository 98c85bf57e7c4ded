// SPDX-License-Identifier: Apache-2.0
#include "versine/io/monitoring_file.hpp"

#include <fmt/format.h>

#include <fstream>

#include "monitoring_source.hpp"

namespace versine::io {

namespace {
bool is_hdf5(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  char head[4] = {};
  return stream.read(head, 4) && std::string_view(head, 4) == "\x89HDF";
}
}  // namespace

MonitoringReader::MonitoringReader(std::unique_ptr<Source> source) : source_(std::move(source)) {}
MonitoringReader::MonitoringReader(MonitoringReader&&) noexcept = default;
MonitoringReader::~MonitoringReader() = default;

std::uint64_t MonitoringReader::samples() const {
  return source_->samples();
}

Expected<MonitoringReader> MonitoringReader::open(const MonitoringFile& file) {
  const auto bad = [&](std::string field, std::string found, std::string expected) {
    return fail({.file = file.path.string(),
                 .field = std::move(field),
                 .found = std::move(found),
                 .expected = std::move(expected),
                 .advice = "see docs/monitoring.md"});
  };
  if (file.channels.empty()) return bad("channels", "none", "the names of datasets or columns");
  if (file.times.empty() == !file.rate_hz) {
    return bad("times", file.rate_hz ? "both times and rate_hz" : "neither times nor rate_hz", "one of them");
  }
  if (file.rate_hz && !(*file.rate_hz > 0.0)) return bad("rate_hz", "a rate that is not positive", "samples a second");
  auto source = is_hdf5(file.path) ? open_monitoring_hdf5(file) : open_monitoring_csv(file);
  if (!source) return tl::unexpected(source.error());
  return MonitoringReader(std::move(*source));
}

Expected<bool> MonitoringReader::next(georef::SampleBlock& block) {
  const bool has_times = !source_->file().times.empty();
  const Time before = has_times && !block.times.empty() ? block.times.back() : Time{INT64_MIN};
  auto more = source_->read(block);
  if (!more || !*more) return more;
  const MonitoringFile& file = source_->file();
  if (!has_times) {
    block.times.clear();
    const std::size_t count = block.channels.front().size();
    const Time start = Time::from_seconds(file.start_s + file.offset_s);
    for (std::size_t i = 0; i < count; ++i) {
      // The whole number of seconds apart, so that hours at 20 kHz keep their nanoseconds.
      const double n = static_cast<double>(block.first + i), whole = std::floor(n / *file.rate_hz);
      const double rest = (n - whole * *file.rate_hz) / *file.rate_hz;
      block.times.push_back({start.ns + static_cast<std::int64_t>(whole) * 1'000'000'000 + std::llround(rest * 1e9)});
    }
    return true;
  }
  for (std::size_t i = 0; i < block.times.size(); ++i) {
    if (file.offset_s != 0.0) block.times[i] = block.times[i] + Duration::from_seconds(file.offset_s);
    const Time last = i == 0 ? before : block.times[i - 1];
    if (last < block.times[i]) continue;
    return fail({.file = file.path.string(),
                 .line = static_cast<std::size_t>(block.first) + i + 1,
                 .field = file.times,
                 .found = "a time that is not after the one before",
                 .expected = "increasing times",
                 .advice = "where the recorder's clock stands still, give rate_hz and start_s instead"});
  }
  return true;
}

}  // namespace versine::io
