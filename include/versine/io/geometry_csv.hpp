// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "versine/core/error.hpp"
#include "versine/track/geometry.hpp"
#include "versine/track/quality.hpp"

/// Track geometry as CSV. docs/track-geometry.md describes the columns.
namespace versine::io {

/// One row per grid point: `distance_m` (continuous), `mileage_m` (as posted), `time_s`, `flags`, then each column and,
/// where it has one, its `sigma_...`. Missing values are empty fields.
[[nodiscard]] Expected<void> write_geometry_csv(const std::filesystem::path& path, const track::Geometry& geometry);
/// Name, unit and description of each column; conventions above them as `#` lines.
[[nodiscard]] Expected<void> write_geometry_columns_csv(const std::filesystem::path& path,
                                                        const track::Geometry& geometry);
[[nodiscard]] Expected<void> write_exceedances_csv(const std::filesystem::path& path, const track::Geometry& geometry,
                                                   const track::Quality& quality);
[[nodiscard]] Expected<void> write_sections_csv(const std::filesystem::path& path, const track::Geometry& geometry,
                                                const track::Quality& quality);

/// Digits behind the point that a unit deserves: 1 um, 0.1 mm for coordinates.
[[nodiscard]] int decimals_of(const track::Column& column);

}  // namespace versine::io
