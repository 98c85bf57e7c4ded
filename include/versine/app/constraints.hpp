// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "versine/app/config.hpp"
#include "versine/georef/options.hpp"

namespace versine::app {

/// `[[constraint]]`: the same tables in a job and in a file of their own. Layout: docs/formats-georef.md.
void describe(ConfigVisitor& v, std::vector<georef::Constraint>& constraints);

/// A file of constraints, each with a time span and tracks; whether the map has the tracks is
/// georef::check's to say. Fails naming file, constraint and key.
[[nodiscard]] Expected<std::vector<georef::Constraint>> read_constraints(const std::filesystem::path& path);

}  // namespace versine::app
