// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "versine/core/error.hpp"
#include "versine/georef/recording.hpp"

namespace versine::io {

/// Reads a GNSS log of Infrabel's measuring train: CSV with the columns `timestamp` (ISO 8601, UTC), `latitude`,
/// `longitude` (deg), `solution_status` and `position_type` (NARROW_INT.., NARROW_FLOAT, PSRDIFF, SINGLE,
/// PROPAGATED). There is neither speed nor accuracy in it.
[[nodiscard]] Expected<georef::Recording> read_brussels_log(const std::filesystem::path& path);

}  // namespace versine::io
