// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "versine/io/monitoring_file.hpp"

namespace versine::io {

/// What reads one kind of file.
class MonitoringReader::Source {
 public:
  static constexpr std::size_t block_size = 65536;

  explicit Source(MonitoringFile file) : file_(std::move(file)) {}
  virtual ~Source() = default;
  /// Channels, and times where the file has them, of at most block_size samples; `block.first` is set.
  virtual Expected<bool> read(georef::SampleBlock& block) = 0;
  [[nodiscard]] virtual std::uint64_t samples() const { return 0; }
  [[nodiscard]] const MonitoringFile& file() const { return file_; }

 protected:
  [[nodiscard]] Error trouble(std::string field, std::string found, std::string expected) const {
    return {.file = file_.path.string(),
            .field = std::move(field),
            .found = std::move(found),
            .expected = std::move(expected),
            .advice = "see docs/monitoring.md"};
  }
  MonitoringFile file_;
};

[[nodiscard]] Expected<std::unique_ptr<MonitoringReader::Source>> open_monitoring_hdf5(const MonitoringFile& file);
[[nodiscard]] Expected<std::unique_ptr<MonitoringReader::Source>> open_monitoring_csv(const MonitoringFile& file);

}  // namespace versine::io
