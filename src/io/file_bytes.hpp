// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "versine/core/error.hpp"

namespace versine::io {

/// The whole content of a file, unpacked when its first bytes are those of zstd or gzip.
[[nodiscard]] Expected<std::string> file_bytes(const std::filesystem::path& path);

}  // namespace versine::io
