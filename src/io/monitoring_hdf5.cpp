// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "hdf5_handle.hpp"
#include "monitoring_source.hpp"

namespace versine::io {

namespace {
class Hdf5Source final : public MonitoringReader::Source {
 public:
  using Source::Source;

  Expected<void> open() {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    h5_ = Hdf5Handle(H5Fopen(file_.path.string().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (h5_ < 0) return fail(trouble("file", "a file that HDF5 cannot read", "HDF5, copied whole"));
    for (const auto& name : file_.channels) {
      if (auto set = open_set(name, channels_)) return fail(*set);
    }
    if (file_.times.empty()) return {};
    std::vector<Hdf5Handle> times;
    if (auto set = open_set(file_.times, times)) return fail(*set);
    times_ = std::move(times.front());
    const Hdf5Handle type(H5Dget_type(times_), H5Tclose);
    integer_times_ = H5Tget_class(type) == H5T_INTEGER;
    return {};
  }

  Expected<bool> read(georef::SampleBlock& block) override {
    const std::uint64_t count = std::min<std::uint64_t>(block_size, size_ - at_);
    block.first = at_;
    block.channels.resize(channels_.size());
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      block.channels[c].resize(count);
      if (!get(channels_[c], H5T_NATIVE_FLOAT, block.channels[c].data(), count)) return unreadable(file_.channels[c]);
      if (file_.scale == 1.0) continue;
      for (float& x : block.channels[c]) x = static_cast<float>(x * file_.scale);
    }
    if (times_ >= 0 && !read_times(block, count)) return unreadable(file_.times);
    at_ += count;
    return count > 0;
  }

  [[nodiscard]] std::uint64_t samples() const override { return size_; }

 private:
  std::optional<Error> open_set(const std::string& name, std::vector<Hdf5Handle>& sets) {
    Hdf5Handle set(H5Dopen2(h5_, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (set < 0) return trouble(name, "no such dataset", "a dataset of one dimension");
    const Hdf5Handle space(H5Dget_space(set), H5Sclose);
    hsize_t size = 0;
    if (H5Sget_simple_extent_ndims(space) != 1) return trouble(name, "several dimensions", "one dimension");
    H5Sget_simple_extent_dims(space, &size, nullptr);
    if (channels_.empty()) size_ = size;
    if (size != size_) {
      return trouble(name, fmt::format("{} values where {} has {}", size, file_.channels.front(), size_),
                     "as many values in each");
    }
    sets.push_back(std::move(set));
    return std::nullopt;
  }

  [[nodiscard]] bool get(hid_t set, hid_t type, void* to, hsize_t count) const {
    if (count == 0) return true;
    const hsize_t from = at_;
    const Hdf5Handle space(H5Dget_space(set), H5Sclose), memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
    return H5Sselect_hyperslab(space, H5S_SELECT_SET, &from, nullptr, &count, nullptr) >= 0 &&
           H5Dread(set, type, memory, space, H5P_DEFAULT, to) >= 0;
  }

  bool read_times(georef::SampleBlock& block, std::size_t count) {
    block.times.resize(count);
    if (integer_times_) {
      integers_.resize(count);
      if (!get(times_, H5T_NATIVE_INT64, integers_.data(), count)) return false;
      for (std::size_t i = 0; i < count; ++i) block.times[i] = {integers_[i]};
      return true;
    }
    seconds_.resize(count);
    if (!get(times_, H5T_NATIVE_DOUBLE, seconds_.data(), count)) return false;
    for (std::size_t i = 0; i < count; ++i) block.times[i] = Time::from_seconds(seconds_[i]);
    return true;
  }

  [[nodiscard]] tl::unexpected<Error> unreadable(const std::string& name) const {
    return fail(trouble(name, fmt::format("values behind {} that cannot be read", at_), "a file copied whole"));
  }

  Hdf5Handle h5_, times_;
  std::vector<Hdf5Handle> channels_;
  bool integer_times_ = false;
  std::uint64_t size_ = 0, at_ = 0;
  std::vector<double> seconds_;
  std::vector<std::int64_t> integers_;
};
}  // namespace

Expected<std::unique_ptr<MonitoringReader::Source>> open_monitoring_hdf5(const MonitoringFile& file) {
  auto source = std::make_unique<Hdf5Source>(file);
  if (const auto opened = source->open(); !opened) return tl::unexpected(opened.error());
  return std::unique_ptr<MonitoringReader::Source>(std::move(source));
}

}  // namespace versine::io
