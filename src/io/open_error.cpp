// SPDX-License-Identifier: Apache-2.0
#include "versine/io/open_error.hpp"

#include <cerrno>
#include <cstring>

namespace versine::io {

Error open_error(const std::filesystem::path& path) {
  const int reason = errno;
  const bool missing = reason == ENOENT;
  return {.file = path.string(),
          .found = missing ? "no such file" : std::string("that it cannot be read: ") + std::strerror(reason),
          .expected = "a readable file",
          .advice = missing ? "check the path; relative paths in a job count from the job file"
                            : "check the file's permissions"};
}

}  // namespace versine::io
