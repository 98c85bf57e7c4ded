// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "versine/io/input_stream.hpp"

namespace versine::io {

/// Lines of a text file, without their ends (LF or CRLF) and without a byte order mark. Holds one block of the file in
/// memory, whatever its size.
class LineReader {
 public:
  [[nodiscard]] static Expected<LineReader> open(const std::filesystem::path& path);
  [[nodiscard]] static LineReader from_text(std::string text, std::string name = "text");

  /// The next line, valid until the next call; false at the end and on a fault (see `error`).
  [[nodiscard]] bool next(std::string_view& line);
  /// The line given last, once more by the next call of `next`.
  void put_back() { at_ = line_start_, --line_number_; }
  /// Damaged compression, or a file that is not text.
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }
  [[nodiscard]] std::size_t line_number() const { return line_number_; }  ///< of the line given last, from 1
  [[nodiscard]] const std::string& name() const { return stream_.name(); }
  /// True when the line given last had no end of line behind it: the file may have been cut short there.
  [[nodiscard]] bool unterminated() const { return unterminated_; }

 private:
  explicit LineReader(InputStream stream) : stream_(std::move(stream)) {}
  bool fill();

  InputStream stream_;
  std::vector<char> buffer_;
  std::size_t line_start_ = 0, at_ = 0, end_ = 0;
  std::size_t line_number_ = 0;
  bool at_end_ = false, unterminated_ = false;
  std::optional<Error> error_;
};

}  // namespace versine::io
