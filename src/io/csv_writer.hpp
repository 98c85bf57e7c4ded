// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/compile.h>
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string_view>
#include <utility>

#include "versine/core/error.hpp"
#include "versine/core/time.hpp"

namespace versine::io {

/// A text file, written in blocks of 64 KiB; `close` tells whether all of it reached the disk.
class CsvWriter {
 public:
  CsvWriter(std::filesystem::path path, std::string_view header) : path_(std::move(path)) {
    file_.reset(std::fopen(path_.string().c_str(), "wb"));
    row("{}", header);
  }

  template <class... Args>
  void row(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(buffer_), format, std::forward<Args>(args)...);
    buffer_.push_back('\n');
    if (buffer_.size() > 65536) flush();
  }

  [[nodiscard]] Expected<void> close() {
    flush();
    if (file_ && std::fclose(file_.release()) == 0 && good_) return {};
    return fail({.file = path_.string(),
                 .found = "the file could not be written",
                 .expected = "a folder that can be written and room on the disk",
                 .advice = "free some space, or choose another folder with --output"});
  }

 private:
  struct Close {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  void flush() {
    good_ = good_ && file_ && std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) == buffer_.size();
    buffer_.clear();
  }
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
  fmt::memory_buffer buffer_;
  bool good_ = true;
};

/// Exact seconds of a time: "1400000000.005000000".
struct ExactSeconds {
  Time time;
};

}  // namespace versine::io

template <>
struct fmt::formatter<versine::io::ExactSeconds> {
  constexpr auto parse(format_parse_context& context) { return context.begin(); }
  template <class Context>
  auto format(const versine::io::ExactSeconds& s, Context& context) const {
    const bool negative = s.time.ns < 0;
    const auto ns = negative ? 0 - static_cast<std::uint64_t>(s.time.ns) : static_cast<std::uint64_t>(s.time.ns);
    return fmt::format_to(context.out(), "{}{}.{:09d}", negative ? "-" : "", ns / 1'000'000'000, ns % 1'000'000'000);
  }
};
