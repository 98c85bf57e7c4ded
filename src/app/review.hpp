// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "versine/core/error.hpp"

namespace versine::app {

/// Writes what a reviewer decided (a JSON array of constraints, docs/formats-georef.md) as the TOML that `versine
/// georef` reads; whole or not at all. Fails naming the constraint and key that is not understood.
[[nodiscard]] Expected<void> write_constraints(const std::filesystem::path& path, const std::string& json);

/// The file's constraints as such a JSON array; empty when there is no file.
[[nodiscard]] Expected<std::string> read_constraints(const std::filesystem::path& path);

}  // namespace versine::app
