// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "hdf5_handle.hpp"

namespace versine::io {

/// A group whose datasets are columns that grow together, row by row; memory holds 8,192 rows at most. Integers are
/// kept exactly in columns of kind `integer`.
class Hdf5Columns {
 public:
  enum class Kind { real, single, integer };
  struct Column {
    std::string name;
    Kind kind = Kind::real;
  };

  Hdf5Columns(hid_t file, const std::string& group, const std::vector<Column>& columns);
  Hdf5Columns(Hdf5Columns&&) = default;

  /// Values of a row, in the order of the columns.
  void put(double value) { columns_[next()].values.push_back(value); }
  void put(std::int64_t value) { columns_[next()].integers.push_back(value); }
  void end_row() {
    if (++rows_ >= 8192) flush();
  }
  void flush();
  [[nodiscard]] bool good() const { return good_; }

 private:
  struct Open {
    Kind kind;
    Hdf5Handle set;
    std::vector<double> values;
    std::vector<std::int64_t> integers;
  };
  std::size_t next() {
    const std::size_t i = at_;
    at_ = (at_ + 1) % columns_.size();
    return i;
  }
  Hdf5Handle group_;
  std::vector<Open> columns_;
  std::size_t at_ = 0, rows_ = 0;
  hsize_t size_ = 0;
  bool good_ = true;
};

}  // namespace versine::io
