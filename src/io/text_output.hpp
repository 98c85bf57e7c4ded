// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <iterator>
#include <string>

#include "versine/core/error.hpp"

namespace versine::io {

/// A text file that is written in blocks; every fault of the disk comes out at `close`.
class TextOutput {
 public:
  explicit TextOutput(const std::filesystem::path& path)
      : path_(path), file_(std::fopen(path.string().c_str(), "wb")), good_(file_ != nullptr) {
    buffer_.reserve(block + 4096);
  }
  TextOutput(const TextOutput&) = delete;
  TextOutput& operator=(const TextOutput&) = delete;
  ~TextOutput() {
    if (file_ != nullptr) std::fclose(file_);
  }

  template <class... T>
  void print(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(buffer_), format, std::forward<T>(values)...);
    if (buffer_.size() > block) flush();
  }
  /// Writes `value` with `decimals` digits behind the point; nothing for NaN.
  void number(double value, int decimals);
  void text(std::string_view s) { buffer_.append(s.data(), s.data() + s.size()); }
  void end_line() {
    buffer_.push_back('\n');
    if (buffer_.size() > block) flush();
  }

  [[nodiscard]] Expected<void> close() {
    flush();
    if (file_ != nullptr && std::fclose(file_) != 0) good_ = false;
    file_ = nullptr;
    if (good_) return {};
    return fail({.file = path_.string(),
                 .found = "that it cannot be written",
                 .expected = "a writable place with free space",
                 .advice = "check permissions and free space"});
  }

 private:
  static constexpr std::size_t block = std::size_t{1} << 20;
  void flush() {
    if (good_) good_ = std::fwrite(buffer_.data(), 1, buffer_.size(), file_) == buffer_.size();
    buffer_.clear();
  }

  std::filesystem::path path_;
  std::FILE* file_;
  bool good_;
  fmt::memory_buffer buffer_;
};

}  // namespace versine::io
