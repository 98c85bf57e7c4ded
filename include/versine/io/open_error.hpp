// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "versine/core/error.hpp"

namespace versine::io {

/// Why a file could not be opened, by `errno` as the failed call left it.
[[nodiscard]] Error open_error(const std::filesystem::path& path);

}  // namespace versine::io
