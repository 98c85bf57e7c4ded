// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/georef/monitoring.hpp"

namespace versine::io {

/// A file of monitoring channels, and how its samples get their times.
struct MonitoringFile {
  std::filesystem::path path;
  std::vector<std::string> channels;  ///< HDF5: datasets of one dimension; CSV: columns
  std::string times;                  ///< HDF5: dataset of seconds (or integer ns); CSV: column of seconds; or
  std::optional<double> rate_hz;      ///< the sampling rate, with
  double start_s = 0.0;               ///< the time of the first sample
  double offset_s = 0.0;              ///< added to every time
  double scale = 1.0;                 ///< the channels' numbers times this
};

/// Reads a monitoring file block by block (HDF5, or CSV, by its first bytes); never holds more than a block. The file
/// is opened for reading only.
class MonitoringReader {
 public:
  [[nodiscard]] static Expected<MonitoringReader> open(const MonitoringFile& file);
  MonitoringReader(MonitoringReader&&) noexcept;
  ~MonitoringReader();

  /// Fills the block with the next samples, at most 65,536. False at the end. Fails where times do not increase, and
  /// where the file cannot be read on.
  [[nodiscard]] Expected<bool> next(georef::SampleBlock& block);
  /// Samples in the file; 0 where that is not known before its end.
  [[nodiscard]] std::uint64_t samples() const;

  class Source;

 private:
  explicit MonitoringReader(std::unique_ptr<Source> source);
  std::unique_ptr<Source> source_;
};

}  // namespace versine::io
