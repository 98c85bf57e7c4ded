// SPDX-License-Identifier: Apache-2.0
#include "file_bytes.hpp"

#include <zlib.h>
#include <zstd.h>

#include <fstream>
#include <memory>

namespace versine::io {

namespace {

tl::unexpected<Error> damaged(const std::filesystem::path& path, const char* what) {
  return fail({.file = path.string(),
               .found = what,
               .expected = "a whole compressed file",
               .advice = "copy or download the file again"});
}

Expected<std::string> unpack_zstd(const std::filesystem::path& path, const std::string& packed) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(), &ZSTD_freeDCtx);
  std::string out;
  const auto told = ZSTD_getFrameContentSize(packed.data(), packed.size());
  out.resize(told == ZSTD_CONTENTSIZE_UNKNOWN || told == ZSTD_CONTENTSIZE_ERROR ? packed.size() * 4 + 1024 : told);
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  std::size_t filled = 0, state = 1;
  while (in.pos < in.size) {
    if (filled == out.size()) out.resize(out.size() * 2 + 1024);
    ZSTD_outBuffer piece{out.data() + filled, out.size() - filled, 0};
    state = ZSTD_decompressStream(context.get(), &piece, &in);
    if (ZSTD_isError(state) != 0) return damaged(path, ZSTD_getErrorName(state));
    filled += piece.pos;
  }
  while (state != 0) {  // the input is used up, the context may still hold output
    if (filled == out.size()) out.resize(out.size() * 2 + 1024);
    ZSTD_outBuffer piece{out.data() + filled, out.size() - filled, 0};
    state = ZSTD_decompressStream(context.get(), &piece, &in);
    if (ZSTD_isError(state) != 0 || piece.pos == 0) return damaged(path, "a compressed file that ends early");
    filled += piece.pos;
  }
  out.resize(filled);
  return out;
}

Expected<std::string> unpack_gzip(const std::filesystem::path& path) {
  const std::unique_ptr<gzFile_s, decltype(&gzclose)> file(gzopen(path.c_str(), "rb"), &gzclose);
  if (!file) return damaged(path, "a file that cannot be opened");
  std::string out;
  char buffer[1 << 16];
  int n = 0;
  while ((n = gzread(file.get(), buffer, sizeof buffer)) > 0) out.append(buffer, static_cast<std::size_t>(n));
  if (n < 0 || gzeof(file.get()) == 0) return damaged(path, "a compressed file that ends early or is damaged");
  return out;
}

}  // namespace

Expected<std::string> file_bytes(const std::filesystem::path& path) {
  std::error_code code;
  const auto size = std::filesystem::file_size(path, code);
  std::ifstream stream(path, std::ios::binary);
  if (code || !stream) {
    return fail({.file = path.string(),
                 .found = "no file that can be read",
                 .expected = "a readable file",
                 .advice = "check the path and its permissions"});
  }
  std::string bytes(size, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!stream) return damaged(path, "a file that ends while it is read");
  if (bytes.starts_with("\x28\xB5\x2F\xFD")) return unpack_zstd(path, bytes);
  if (bytes.starts_with("\x1F\x8B")) return unpack_gzip(path);
  return bytes;
}

}  // namespace versine::io
