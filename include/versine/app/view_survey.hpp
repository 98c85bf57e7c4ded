// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "versine/app/view_server.hpp"
#include "versine/core/error.hpp"

namespace versine::app {

/// The survey screen: of `versine survey` and `versine geometry`. Without track geometry it shows the trajectory over
/// time. `run_json` is the content of run.json.
[[nodiscard]] Expected<ViewContent> open_survey_view(const std::filesystem::path& folder, const std::string& run_json,
                                                     const std::optional<std::filesystem::path>& compare);

}  // namespace versine::app
