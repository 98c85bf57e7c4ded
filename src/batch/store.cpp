// SPDX-License-Identifier: Apache-2.0
#include "versine/batch/store.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <random>

#include "versine/core/file_system.hpp"
#include "versine/io/sha256.hpp"

namespace versine::batch {

namespace fs = std::filesystem;

namespace {
Failure trouble(const fs::path& path, std::string found) {
  return {Exit::again,
          {.file = path.string(),
           .found = std::move(found),
           .expected = "a store with free space that can be read and written",
           .advice = "give the store space or permission, then run the same command again"}};
}

/// Two machines may share a host name and a process number; these names they do not share.
std::string fresh_name() {
  std::random_device device;
  return fmt::format("{}-{:08x}{:08x}", process_id(), device(), device());
}

bool write_whole(const fs::path& path, std::string_view bytes) {
  std::FILE* file = std::fopen(path.string().c_str(), "wbx");
  if (file == nullptr) return false;
  bool good = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  good = std::fflush(file) == 0 && good;
  return std::fclose(file) == 0 && good && flush_one(path);
}
}  // namespace

Outcome<Store> Store::open(const fs::path& folder, bool make) {
  std::error_code code;
  Store store(fs::absolute(folder, code));
  if (!make && !fs::is_directory(store.manifests(), code)) {
    return failure(Exit::usage, {.file = folder.string(),
                                 .found = "no store",
                                 .expected = "a folder with manifests/, objects/, receipts/",
                                 .advice = "name it with --store or VERSINE_STORE; 'versine batch plan' makes one"});
  }
  for (const auto& path : {store.manifests(), store.objects(), store.receipts(), store.folder_ / "logs", store.tmp()}) {
    fs::create_directories(path, code);
    if (code) return tl::unexpected(trouble(path, code.message()));
  }
  return store;
}

fs::path Store::log(const std::string& manifest) const {
  return folder_ / "logs" / (manifest + ".jsonl");
}
fs::path Store::object(const std::string& sha256) const {
  return objects() / sha256.substr(0, 2) / sha256;
}
fs::path Store::receipt(const std::string& unit) const {
  return receipts() / unit.substr(0, 2) / (unit + ".json");
}

Outcome<fs::path> Store::write_tmp(std::string_view bytes) const {
  const fs::path path = tmp() / fresh_name();
  if (write_whole(path, bytes)) return path;
  const std::string reason = std::strerror(errno);
  std::error_code code;
  fs::remove(path, code);
  return tl::unexpected(trouble(path, reason));
}

Outcome<std::string> Store::put(std::string_view bytes) const {
  const std::string name = io::sha256(bytes);
  const auto written = write_tmp(bytes);
  if (!written) return tl::unexpected(written.error());
  const fs::path target = object(name);
  std::error_code code;
  fs::create_directories(target.parent_path(), code);
  if (!code) fs::rename(*written, target, code);
  if (code || !flush_one(target.parent_path())) {
    const std::string reason = code ? code.message() : std::string("that its folder cannot be flushed");
    fs::remove(*written, code);
    return tl::unexpected(trouble(target, reason));
  }
  return name;
}

Outcome<std::string> Store::get(const std::string& sha256) const {
  auto bytes = read_file(object(sha256));
  if (bytes && io::sha256(*bytes) != sha256) {
    return failure(Exit::again, {.file = object(sha256).string(),
                                 .found = "a content of another SHA-256",
                                 .expected = "an object as it was written",
                                 .advice = "'versine batch verify' withdraws its receipt, 'run --missing' repeats it"});
  }
  return bytes;
}

Outcome<std::string> read_file(const fs::path& path) {
  std::FILE* file = std::fopen(path.string().c_str(), "rb");
  if (file == nullptr) return tl::unexpected(trouble(path, std::strerror(errno)));
  std::string bytes;
  char block[1 << 16];
  while (const std::size_t n = std::fread(block, 1, sizeof block, file)) bytes.append(block, n);
  const bool good = std::ferror(file) == 0;
  std::fclose(file);
  if (!good) return tl::unexpected(trouble(path, "that it cannot be read whole"));
  return bytes;
}

}  // namespace versine::batch
