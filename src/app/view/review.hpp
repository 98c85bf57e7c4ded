// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "versine/core/error.hpp"

namespace versine::app {

/// Keeps what a reviewer decided (a JSON array of constraints, docs/formats-georef.md) as the TOML that `versine
/// georef` reads; whole or not at all. Fails naming the constraint and key that is not understood, and rather than
/// replace a file that holds something else.
[[nodiscard]] Expected<void> save_review(const std::filesystem::path& path, const std::string& json);

/// The file's constraints as such a JSON array; empty when there is no file.
[[nodiscard]] Expected<std::string> load_review(const std::filesystem::path& path);

}  // namespace versine::app
