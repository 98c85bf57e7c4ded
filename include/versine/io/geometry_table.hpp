// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "versine/core/error.hpp"

namespace versine::io {

/// geometry.csv as write_geometry_csv wrote it, read back by columns: the units are those of the file. The file stays
/// mapped, so that a replaced or removed result can still be read to its end.
class GeometryTable {
 public:
  /// Maps the file, reads its header and finds its lines. Fails when there is no header or the last line is cut short.
  [[nodiscard]] static Expected<GeometryTable> open(const std::filesystem::path& path);

  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  [[nodiscard]] bool has(const std::string& column) const;
  [[nodiscard]] std::size_t rows() const { return lines_.size() - 1; }

  /// The columns asked for, in that order, in one pass over the file on all cores; NaN where a field is empty.
  /// REQUIRES that they exist. Fails with the line when a field is no number or a line has too few fields.
  [[nodiscard]] Expected<std::vector<std::vector<double>>> read(std::span<const std::string> columns) const;

 private:
  struct Mapping;
  GeometryTable() = default;
  std::string name_;
  std::shared_ptr<const Mapping> mapping_;
  std::vector<std::string> columns_;
  std::vector<std::size_t> lines_;  ///< where each line of data begins; the last is the end of the file
};

}  // namespace versine::io
