// SPDX-License-Identifier: Apache-2.0
#include "hdf5_columns.hpp"

namespace versine::io {

namespace {
void text_attribute(hid_t object, const char* name, const std::string& text) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, text.empty() ? 1 : text.size());
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, type, text.c_str());
  H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
}
}  // namespace

Hdf5Columns::Hdf5Columns(const std::filesystem::path& path, TimeScale scale)
    : path_(path),
      epoch_(scale == TimeScale::gps   ? "GPS time, from 1980-01-06"
             : scale == TimeScale::utc ? "UTC, from 1970-01-01"
                                       : "the recorder's own clock") {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // our own Error tells it
  file_ = H5Fcreate(path.string().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  good_ = file_ >= 0;
}

Hdf5Columns::~Hdf5Columns() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Columns::put(const std::string& group, const std::string& name, const std::string& unit, hid_t type,
                      const void* values, std::size_t count) {
  if (!good_) return;
  const hid_t links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  const hsize_t size = count;
  const hid_t space = H5Screate_simple(1, &size, nullptr);
  const hid_t create = H5Pcreate(H5P_DATASET_CREATE);
  if (count > 4096) {
    const hsize_t chunk = 65536 < count ? 65536 : count;
    H5Pset_chunk(create, 1, &chunk);
    H5Pset_shuffle(create);
    H5Pset_deflate(create, 1);
  }
  const std::string path = group.empty() ? name : group + "/" + name;
  const hid_t set = H5Dcreate2(file_, path.c_str(), type, space, links, create, H5P_DEFAULT);
  good_ = set >= 0 && (count == 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
  if (set >= 0) {
    text_attribute(set, "unit", unit);
    H5Dclose(set);
  }
  H5Pclose(create);
  H5Pclose(links);
  H5Sclose(space);
}

void Hdf5Columns::column(const std::string& group, const std::string& name, const std::string& unit,
                         const std::vector<double>& values) {
  put(group, name, unit, H5T_NATIVE_DOUBLE, values.data(), values.size());
}

void Hdf5Columns::times(const std::string& group, const std::vector<std::int64_t>& nanoseconds) {
  put(group, "time", "ns, " + epoch_, H5T_NATIVE_INT64, nanoseconds.data(), nanoseconds.size());
}

void Hdf5Columns::attribute(const std::string& name, double value) {
  if (!good_) return;
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(file_, name.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT);
  good_ = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value) >= 0;
  if (attribute >= 0) H5Aclose(attribute);
  H5Sclose(space);
}

Expected<void> Hdf5Columns::close() {
  const bool closed = file_ >= 0 && H5Fclose(file_) >= 0;
  file_ = -1;
  if (good_ && closed) return {};
  return fail({.file = path_.string(),
               .found = "the HDF5 file could not be written",
               .expected = "a folder that can be written and room on the disk",
               .advice = "free some space, or choose another folder with --output"});
}

}  // namespace versine::io
