// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "versine/core/error.hpp"
#include "versine/track/geometry.hpp"
#include "versine/track/quality.hpp"

namespace versine::io {

/// A workbook for people: conventions, exceedances, sections of 200 m, and the geometry every `interval` metres or,
/// when `at_sleepers` is given, at every sleeper (a sheet holds a million rows).
[[nodiscard]] Expected<void> write_geometry_xlsx(const std::filesystem::path& path, const track::Geometry& geometry,
                                                 const track::Quality* quality, const track::Geometry* at_sleepers,
                                                 double interval = 5.0);

}  // namespace versine::io
