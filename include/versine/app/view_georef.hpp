// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "versine/app/view_server.hpp"
#include "versine/core/error.hpp"

namespace versine::app {

/// The georeferencing screen, from the files of docs/formats-georef.md. `run_json` is the content of run.json. What a
/// reviewer decides is written to constraints_file(folder), never into the result.
[[nodiscard]] Expected<ViewContent> open_georef_view(const std::filesystem::path& folder, const std::string& run_json,
                                                     const std::optional<std::filesystem::path>& compare);

/// Beside the result: RESULT.constraints.toml, in the layout that `versine georef` reads.
[[nodiscard]] std::filesystem::path constraints_file(const std::filesystem::path& folder);

}  // namespace versine::app
