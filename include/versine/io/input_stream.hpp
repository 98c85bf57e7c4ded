// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "versine/core/error.hpp"

namespace versine::io {

/// The bytes of a file, decompressed as they are read when the file begins with the mark of gzip or zstd, whatever its
/// name. Several compressed members one after another count as one.
class InputStream {
 public:
  /// Fails when the file is missing, a folder, unreadable or empty.
  [[nodiscard]] static Expected<InputStream> open(const std::filesystem::path& path);
  /// Text in memory, for tests and for callers that hold the content already; `name` serves messages.
  [[nodiscard]] static InputStream from_text(std::string text, std::string name);

  InputStream(InputStream&&) noexcept;
  InputStream& operator=(InputStream&&) noexcept;
  ~InputStream();

  /// Fills `into` and returns how much was there; 0 at the end. Fails when compressed data are damaged or cut short.
  [[nodiscard]] Expected<std::size_t> read(std::span<char> into);
  [[nodiscard]] const std::string& name() const { return name_; }

  struct Source;

 private:
  InputStream(std::unique_ptr<Source> source, std::string name);
  std::unique_ptr<Source> source_;
  std::string name_;
};

/// The whole content, decompressed; fails above `limit` bytes.
[[nodiscard]] Expected<std::string> read_text(const std::filesystem::path& path,
                                              std::size_t limit = std::size_t{1} << 30);

}  // namespace versine::io
