// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/georef/monitoring.hpp"

namespace versine::io {

/// Writes what stands beside a monitoring file, as it comes: HDF5 groups `table`, `metres`, `positions` with a dataset
/// a column, and `tracks`. Layout: docs/formats-georef.md.
class MonitoringResult {
 public:
  /// `source`: the monitoring file's name, kept as an attribute.
  [[nodiscard]] static Expected<MonitoringResult> create(const std::filesystem::path& path, const std::string& source,
                                                         const georef::Map& map,
                                                         const std::vector<std::string>& channels);
  MonitoringResult(MonitoringResult&&) noexcept;
  ~MonitoringResult();

  /// Takes the rows that the stamper has, and empties them there.
  void take(georef::MonitoringStamper& stamper);
  /// Fails when anything could not be written.
  [[nodiscard]] Expected<void> close();

 private:
  struct Impl;
  explicit MonitoringResult(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace versine::io
