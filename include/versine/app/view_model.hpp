// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>

#include "versine/app/view_server.hpp"
#include "versine/core/error.hpp"

/// What the viewer shows of a result folder. The JSON's shape is viewer/src/contract.ts.
namespace versine::app {

/// Opens a finished result by the command in its run.json; `compare` is another result of the same kind, which is
/// subtracted. Fails with the cure when the folder is empty, half, of another version or of a job without a screen.
[[nodiscard]] Expected<ViewContent> open_view(const std::filesystem::path& folder,
                                              const std::optional<std::filesystem::path>& compare = {});

/// The same, and follows a job that writes this folder: before its first result there is only its progress; when the
/// result is replaced it is opened anew, and the page learns that from /api/progress. `background` is a raster to draw
/// under the plan (io::BackgroundMap).
[[nodiscard]] Expected<ViewContent> follow_view(const std::filesystem::path& folder,
                                                const std::optional<std::filesystem::path>& compare = {},
                                                const std::optional<std::filesystem::path>& background = {});

}  // namespace versine::app
