// SPDX-License-Identifier: Apache-2.0
#include "hdf5_columns.hpp"

namespace versine::io {

Hdf5Columns::Hdf5Columns(hid_t file, const std::string& group, const std::vector<Column>& columns)
    : group_(H5Gcreate2(file, group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose) {
  const hsize_t none = 0, unlimited = H5S_UNLIMITED, chunk = 8192;
  const Hdf5Handle space(H5Screate_simple(1, &none, &unlimited), H5Sclose);
  const Hdf5Handle options = untimed_dataset();
  H5Pset_chunk(options, 1, &chunk);
  H5Pset_shuffle(options);
  H5Pset_deflate(options, 1);
  for (const Column& c : columns) {
    const hid_t type = c.kind == Kind::integer  ? H5T_STD_I64LE
                       : c.kind == Kind::single ? H5T_IEEE_F32LE
                                                : H5T_IEEE_F64LE;
    Hdf5Handle set(H5Dcreate2(group_, c.name.c_str(), type, space, H5P_DEFAULT, options, H5P_DEFAULT), H5Dclose);
    good_ = good_ && set >= 0;
    columns_.push_back({c.kind, std::move(set), {}, {}});
  }
}

void Hdf5Columns::flush() {
  if (rows_ == 0) return;
  const hsize_t from = size_, count = rows_, size = size_ + count;
  const Hdf5Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
  for (Open& c : columns_) {
    good_ = good_ && H5Dset_extent(c.set, &size) >= 0;
    const Hdf5Handle space(H5Dget_space(c.set), H5Sclose);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, &from, nullptr, &count, nullptr);
    const bool integer = c.kind == Kind::integer;
    const void* data = integer ? static_cast<const void*>(c.integers.data()) : c.values.data();
    good_ =
        good_ && H5Dwrite(c.set, integer ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, data) >= 0;
    c.values.clear(), c.integers.clear();
  }
  size_ = size;
  rows_ = 0;
}

}  // namespace versine::io
