// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/core/time.hpp"

namespace versine::io {

/// A new HDF5 file of named columns: one dataset each, with its unit as attribute; groups are made as named.
class Hdf5Columns {
 public:
  Hdf5Columns(const std::filesystem::path& path, TimeScale scale);
  ~Hdf5Columns();
  Hdf5Columns(const Hdf5Columns&) = delete;
  Hdf5Columns& operator=(const Hdf5Columns&) = delete;

  /// `group` is empty for the root.
  void column(const std::string& group, const std::string& name, const std::string& unit,
              const std::vector<double>& values);
  void times(const std::string& group, const std::vector<std::int64_t>& nanoseconds);
  void attribute(const std::string& name, double value);
  [[nodiscard]] Expected<void> close();

 private:
  void put(const std::string& group, const std::string& name, const std::string& unit, hid_t type, const void* values,
           std::size_t count);
  std::filesystem::path path_;
  std::string epoch_;
  hid_t file_ = -1;
  bool good_ = false;
};

}  // namespace versine::io
