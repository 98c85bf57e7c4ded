// SPDX-License-Identifier: Apache-2.0
#include "versine/io/input_stream.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <vector>

#include "versine/io/open_error.hpp"

namespace versine::io {

/// Fills a span with the next bytes; 0 at the end, a text that says what is wrong instead.
struct InputStream::Source {
  virtual ~Source() = default;
  virtual tl::expected<std::size_t, std::string> read(std::span<char> into) = 0;
};

namespace {
using Result = tl::expected<std::size_t, std::string>;
using SourcePtr = std::unique_ptr<InputStream::Source>;

constexpr std::size_t stream_block = std::size_t{1} << 17;

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

class PlainFile final : public InputStream::Source {
 public:
  explicit PlainFile(std::FILE* file) : file_(file) {}
  Result read(std::span<char> into) override {
    const std::size_t n = std::fread(into.data(), 1, into.size(), file_.get());
    if (n == 0 && std::ferror(file_.get()) != 0)
      return tl::unexpected(std::string("a fault of the disk while reading"));
    return n;
  }
  /// The first bytes, which stay unread.
  std::string peek(std::size_t n) {
    std::string head(n, '\0');
    head.resize(std::fread(head.data(), 1, n, file_.get()));
    std::rewind(file_.get());
    return head;
  }

 private:
  std::unique_ptr<std::FILE, FileCloser> file_;
};

class Memory final : public InputStream::Source {
 public:
  explicit Memory(std::string text) : text_(std::move(text)) {}
  Result read(std::span<char> into) override {
    const std::size_t n = std::min(into.size(), text_.size() - at_);
    std::memcpy(into.data(), text_.data() + at_, n);
    at_ += n;
    return n;
  }

 private:
  std::string text_;
  std::size_t at_ = 0;
};

class GzipSource final : public InputStream::Source {
 public:
  explicit GzipSource(SourcePtr from) : from_(std::move(from)), in_(stream_block) {
    inflateInit2(&z_, 15 + 32);  // 32: zlib or gzip header, found by itself
  }
  GzipSource(const GzipSource&) = delete;
  ~GzipSource() override { inflateEnd(&z_); }

  Result read(std::span<char> into) override {
    z_.next_out = reinterpret_cast<Bytef*>(into.data());
    z_.avail_out = static_cast<uInt>(into.size());
    while (z_.avail_out == into.size()) {
      if (z_.avail_in == 0) {
        const Result n = from_->read(in_);
        if (!n) return n;
        if (*n == 0) {
          if (inside_) return tl::unexpected(std::string("gzip data that end too early"));
          return 0;
        }
        z_.next_in = reinterpret_cast<Bytef*>(in_.data());
        z_.avail_in = static_cast<uInt>(*n);
      }
      inside_ = true;
      const int code = inflate(&z_, Z_NO_FLUSH);
      if (code == Z_STREAM_END) {
        inside_ = false;
        inflateReset(&z_);
      } else if (code != Z_OK && code != Z_BUF_ERROR) {
        return tl::unexpected(std::string("damaged gzip data"));
      }
    }
    return into.size() - z_.avail_out;
  }

 private:
  SourcePtr from_;
  std::vector<char> in_;
  z_stream z_{};
  bool inside_ = true;
};

class ZstdSource final : public InputStream::Source {
 public:
  explicit ZstdSource(SourcePtr from) : from_(std::move(from)), in_(stream_block), z_(ZSTD_createDStream()) {}

  Result read(std::span<char> into) override {
    ZSTD_outBuffer out{into.data(), into.size(), 0};
    while (out.pos == 0) {
      if (input_.pos == input_.size && !(more_)) {
        const Result n = from_->read(in_);
        if (!n) return n;
        if (*n == 0) {
          if (inside_) return tl::unexpected(std::string("zstd data that end too early"));
          return 0;
        }
        input_ = {in_.data(), *n, 0};
      }
      const std::size_t code = ZSTD_decompressStream(z_.get(), &out, &input_);
      if (ZSTD_isError(code) != 0) return tl::unexpected(std::string("damaged zstd data"));
      inside_ = code != 0;
      more_ = out.pos == out.size;  // the decoder may hold more than fitted
    }
    return out.pos;
  }

 private:
  struct Free {
    void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
  };
  SourcePtr from_;
  std::vector<char> in_;
  std::unique_ptr<ZSTD_DStream, Free> z_;
  ZSTD_inBuffer input_{nullptr, 0, 0};
  bool inside_ = true, more_ = false;
};
}  // namespace

InputStream::InputStream(std::unique_ptr<Source> source, std::string name)
    : source_(std::move(source)), name_(std::move(name)) {}
InputStream::InputStream(InputStream&&) noexcept = default;
InputStream& InputStream::operator=(InputStream&&) noexcept = default;
InputStream::~InputStream() = default;

InputStream InputStream::from_text(std::string text, std::string name) {
  return {std::make_unique<Memory>(std::move(text)), std::move(name)};
}

Expected<InputStream> InputStream::open(const std::filesystem::path& path) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) {
    return fail({.file = path.string(), .found = "a folder", .expected = "a file", .advice = "name a file in it"});
  }
  std::FILE* const opened = std::fopen(path.string().c_str(), "rb");
  if (opened == nullptr) return tl::unexpected(open_error(path));
  auto file = std::make_unique<PlainFile>(opened);
  const std::string head = file->peek(4);
  if (head.empty()) {
    return fail({.file = path.string(),
                 .found = "an empty file",
                 .expected = "a recording",
                 .advice = "check whether the recorder or the copy was interrupted"});
  }
  SourcePtr source = std::move(file);
  if (head.starts_with("\x1f\x8b")) source = std::make_unique<GzipSource>(std::move(source));
  if (head.starts_with("\x28\xb5\x2f\xfd")) source = std::make_unique<ZstdSource>(std::move(source));
  return InputStream(std::move(source), path.string());
}

Expected<std::size_t> InputStream::read(std::span<char> into) {
  if (into.empty()) return 0;
  Result n = source_->read(into);
  if (n) return *n;
  return fail({.file = name_, .found = n.error(), .expected = "a whole file", .advice = "copy the file again"});
}

Expected<std::string> read_text(const std::filesystem::path& path, std::size_t limit) {
  auto stream = InputStream::open(path);
  if (!stream) return tl::unexpected(stream.error());
  std::string text;
  std::size_t size = 0;
  while (true) {
    text.resize(std::max<std::size_t>(stream_block, 2 * size));
    const auto n = stream->read(std::span(text).subspan(size));
    if (!n) return tl::unexpected(n.error());
    size += *n;
    if (*n == 0) break;
    if (size > limit) {
      return fail({.file = path.string(),
                   .found = "more than " + std::to_string(limit >> 20) + " MiB",
                   .expected = "a smaller file",
                   .advice = "split the file"});
    }
  }
  text.resize(size);
  return text;
}

}  // namespace versine::io
