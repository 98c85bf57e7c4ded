// SPDX-License-Identifier: Apache-2.0
#include "versine/io/line_reader.hpp"

#include <cstring>

namespace versine::io {

namespace {
constexpr std::size_t line_block = std::size_t{1} << 20;
constexpr std::size_t longest_line = std::size_t{1} << 24;
}  // namespace

Expected<LineReader> LineReader::open(const std::filesystem::path& path) {
  auto stream = InputStream::open(path);
  if (!stream) return tl::unexpected(stream.error());
  return LineReader(std::move(*stream));
}

LineReader LineReader::from_text(std::string text, std::string name) {
  return LineReader(InputStream::from_text(std::move(text), std::move(name)));
}

// Moves the unfinished line to the front of the buffer and reads on behind it. False when there is nothing more.
bool LineReader::fill() {
  const bool first = buffer_.empty();
  const std::size_t rest = end_ - line_start_;
  if (rest > longest_line) {
    error_ = {.file = name(),
              .line = line_number_ + 1,
              .found = "a line of more than 16 million characters",
              .expected = "a text file",
              .advice = "check that the file is text"};
    return false;
  }
  if (rest > 0) std::memmove(buffer_.data(), buffer_.data() + line_start_, rest);
  if (buffer_.size() < rest + line_block) buffer_.resize(rest + line_block);
  at_ -= line_start_;
  line_start_ = 0;
  end_ = rest;
  const auto n = stream_.read(std::span(buffer_).subspan(rest, line_block));
  if (!n) {
    error_ = n.error();
    error_->line = line_number_ + 1;
    return false;
  }
  end_ += *n;
  const std::string_view fresh(buffer_.data() + rest, *n);
  if (first && fresh.starts_with("\xef\xbb\xbf")) at_ = line_start_ = 3;
  if (fresh.find('\0') != std::string_view::npos ||
      (first && (fresh.starts_with("\xff\xfe") || fresh.starts_with("\xfe\xff")))) {
    error_ = {.file = name(),
              .line = line_number_ + 1,
              .found = "bytes that are not text",
              .expected = "a text file (UTF-8 or ASCII), plain, gzip or zstd",
              .advice = "export the recording as text; a file in UTF-16 must be saved as UTF-8"};
    return false;
  }
  return *n > 0;
}

bool LineReader::next(std::string_view& line) {
  if (error_) return false;
  line_start_ = at_;
  std::size_t searched = line_start_;
  const char* found = nullptr;
  while (true) {
    if (end_ > searched) {
      found = static_cast<const char*>(std::memchr(buffer_.data() + searched, '\n', end_ - searched));
      if (found != nullptr) break;
    }
    if (at_end_) break;
    searched = end_ - line_start_;
    if (!fill()) {
      if (error_) return false;
      at_end_ = true;
    }
    searched += line_start_;  // a byte order mark may have moved the start
  }
  std::size_t stop = end_;
  unterminated_ = found == nullptr;
  if (found != nullptr) {
    stop = static_cast<std::size_t>(found - buffer_.data());
    at_ = stop + 1;
  } else {
    if (line_start_ == end_) return false;
    at_ = end_;
  }
  if (stop > line_start_ && buffer_[stop - 1] == '\r') --stop;
  line = {buffer_.data() + line_start_, stop - line_start_};
  ++line_number_;
  return true;
}

}  // namespace versine::io
