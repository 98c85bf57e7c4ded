// SPDX-License-Identifier: Apache-2.0
#include "hdf5_file.hpp"

#include <algorithm>

#include "hdf5_handle.hpp"

namespace versine::io {

namespace {
using Handle = Hdf5Handle;

bool put_text(hid_t object, const std::string& name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(1, text.size()));
  H5Tset_cset(type, H5T_CSET_UTF8);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute >= 0 && H5Awrite(attribute, type, text.empty() ? "" : text.c_str()) >= 0;
}

bool put(hid_t file, const std::string& name, hid_t stored, hid_t in_memory, const void* data, std::size_t count,
         const std::string& unit) {
  const hsize_t size = count;
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Handle options(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  if (count > 4096) {
    const hsize_t chunk = 65536 < size ? 65536 : size;
    H5Pset_chunk(options, 1, &chunk);
    H5Pset_shuffle(options);
    H5Pset_deflate(options, 1);
  }
  const Handle set(H5Dcreate2(file, name.c_str(), stored, space, H5P_DEFAULT, options, H5P_DEFAULT), H5Dclose);
  if (set < 0) return false;
  const bool written = count == 0 || H5Dwrite(set, in_memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
  return written && (unit.empty() || put_text(set, "units", unit));
}

template <class T>
std::optional<std::vector<T>> get(hid_t file, const std::string& name, hid_t in_memory) {
  if (H5Lexists(file, name.c_str(), H5P_DEFAULT) <= 0) return std::nullopt;
  const Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (set < 0) return std::nullopt;
  const Handle space(H5Dget_space(set), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  if (count < 0 || H5Sget_simple_extent_ndims(space) != 1) return std::nullopt;
  std::vector<T> values(static_cast<std::size_t>(count));
  if (count > 0 && H5Dread(set, in_memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) return std::nullopt;
  return values;
}
}  // namespace

Expected<Hdf5File> Hdf5File::create(const std::filesystem::path& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors come as values, nothing is printed
  const hid_t id = H5Fcreate(path.string().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (id >= 0) return Hdf5File(path, id);
  return fail({.file = path.string(),
               .found = "that it cannot be written",
               .expected = "a writable place",
               .advice = "check permissions and free space"});
}

Expected<Hdf5File> Hdf5File::open(const std::filesystem::path& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t id = H5Fopen(path.string().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (id >= 0) return Hdf5File(path, id);
  return fail({.file = path.string(),
               .found = "no HDF5 file, or a damaged one",
               .expected = "an HDF5 file",
               .advice = "copy the file again"});
}

Hdf5File::Hdf5File(Hdf5File&& other) noexcept : path_(std::move(other.path_)), id_(other.id_), good_(other.good_) {
  other.id_ = -1;
}
Hdf5File::~Hdf5File() {
  if (id_ >= 0) H5Fclose(id_);
}

void Hdf5File::group(const std::string& name) {
  const Handle made(H5Gcreate2(id_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  good_ = good_ && made >= 0;
}
void Hdf5File::write(const std::string& name, std::span<const double> values, const std::string& unit) {
  good_ = put(id_, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.data(), values.size(), unit) && good_;
}
void Hdf5File::write(const std::string& name, std::span<const float> values, const std::string& unit) {
  good_ = put(id_, name, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, values.data(), values.size(), unit) && good_;
}
void Hdf5File::write(const std::string& name, std::span<const std::int64_t> values, const std::string& unit) {
  good_ = put(id_, name, H5T_STD_I64LE, H5T_NATIVE_INT64, values.data(), values.size(), unit) && good_;
}
void Hdf5File::write(const std::string& name, std::span<const std::string> values) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  std::vector<const char*> pointers;
  for (const std::string& value : values) pointers.push_back(value.c_str());
  good_ = put(id_, name, type, type, pointers.data(), pointers.size(), "") && good_;
}
void Hdf5File::attribute(const std::string& object, const std::string& name, const std::string& text) {
  const Handle opened(H5Oopen(id_, object.c_str(), H5P_DEFAULT), H5Oclose);
  good_ = opened >= 0 && put_text(opened, name, text) && good_;
}

Expected<void> Hdf5File::close() {
  if (id_ >= 0 && H5Fclose(id_) < 0) good_ = false;
  id_ = -1;
  if (good_) return {};
  return fail({.file = path_.string(),
               .found = "that it cannot be written",
               .expected = "a writable place with free space",
               .advice = "check permissions and free space"});
}

bool Hdf5File::has(const std::string& name) const {
  return H5Lexists(id_, name.c_str(), H5P_DEFAULT) > 0;
}
std::optional<std::vector<double>> Hdf5File::doubles(const std::string& name) const {
  return get<double>(id_, name, H5T_NATIVE_DOUBLE);
}
std::optional<std::vector<std::int64_t>> Hdf5File::integers(const std::string& name) const {
  return get<std::int64_t>(id_, name, H5T_NATIVE_INT64);
}
std::string Hdf5File::text_attribute(const std::string& object, const std::string& name) const {
  if (H5Aexists_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT) <= 0) return {};
  const Handle attribute(H5Aopen_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute), H5Tclose);
  if (attribute < 0 || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) return {};
  std::string text(H5Tget_size(type), '\0');
  if (H5Aread(attribute, type, text.data()) < 0) return {};
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

}  // namespace versine::io
