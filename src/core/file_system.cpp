// SPDX-License-Identifier: Apache-2.0
#include "versine/core/file_system.hpp"

#ifdef _WIN32
#include <process.h>
#else
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#endif

namespace versine {

bool exchange_names(const std::filesystem::path& a, const std::filesystem::path& b) {
#if defined(__linux__) && defined(RENAME_EXCHANGE)
  return renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
#else
  static_cast<void>(a), static_cast<void>(b);
  return false;
#endif
}

bool flush_one(const std::filesystem::path& path) {
#ifdef _WIN32
  static_cast<void>(path);
  return true;
#else
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool good = fsync(file) == 0 || errno == EINVAL;  // some file systems cannot flush a folder
  close(file);
  return good;
#endif
}

void flush_to_disk(const std::filesystem::path& folder) {
#ifdef _WIN32
  static_cast<void>(folder);
#else
  std::error_code code;
  for (const auto& entry : std::filesystem::directory_iterator(folder, code)) static_cast<void>(flush_one(entry.path()));
  static_cast<void>(flush_one(folder));
#endif
}

#ifdef _WIN32
int process_id() {
  return _getpid();
}
bool process_runs(int) {
  return true;
}
#else
int process_id() {
  return getpid();
}
bool process_runs(int id) {
  return id <= 0 || kill(id, 0) == 0 || errno != ESRCH;
}
#endif

}  // namespace versine
