// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "versine/core/error.hpp"

namespace versine::io {

/// The little of HDF5 that results need: groups, one-dimensional datasets, text attributes. Compressed datasets.
class Hdf5File {
 public:
  [[nodiscard]] static Expected<Hdf5File> create(const std::filesystem::path& path);
  [[nodiscard]] static Expected<Hdf5File> open(const std::filesystem::path& path);
  Hdf5File(Hdf5File&& other) noexcept;
  Hdf5File& operator=(Hdf5File&&) = delete;
  ~Hdf5File();

  void group(const std::string& name);
  void write(const std::string& name, std::span<const double> values, const std::string& unit);
  void write(const std::string& name, std::span<const float> values, const std::string& unit);
  void write(const std::string& name, std::span<const std::int64_t> values, const std::string& unit);
  void write(const std::string& name, std::span<const std::string> values);
  void attribute(const std::string& object, const std::string& name, const std::string& text);
  /// Closes the file; an Error when anything could not be written.
  [[nodiscard]] Expected<void> close();

  [[nodiscard]] bool has(const std::string& name) const;
  [[nodiscard]] std::optional<std::vector<double>> doubles(const std::string& name) const;
  [[nodiscard]] std::optional<std::vector<std::int64_t>> integers(const std::string& name) const;
  [[nodiscard]] std::string text_attribute(const std::string& object, const std::string& name) const;

 private:
  Hdf5File(std::filesystem::path path, std::int64_t id) : path_(std::move(path)), id_(id) {}
  std::filesystem::path path_;
  std::int64_t id_;
  bool good_ = true;
};

}  // namespace versine::io
