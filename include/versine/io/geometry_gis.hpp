// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "versine/core/error.hpp"
#include "versine/track/geometry.hpp"
#include "versine/track/quality.hpp"

/// Track geometry for maps and drawings, through GDAL.
namespace versine::io {

struct GisOptions {
  double interval = 1.0;  ///< between points and vertices, m; 0 or less than the grid's step: every grid point
};

/// GeoPackage with the layers `axis`, `rails` (lines with heights), `points` (the columns most asked for, in their
/// units) and `exceedances` (points at the peaks). Opens in QGIS as it is. `quality` may be null.
[[nodiscard]] Expected<void> write_geometry_gpkg(const std::filesystem::path& path, const track::Geometry& geometry,
                                                 const track::Quality* quality, const GisOptions& options = {});

/// DXF with the layers AXIS, RAIL_LEFT, RAIL_RIGHT (3-D polylines) and EXCEEDANCES, in map metres.
[[nodiscard]] Expected<void> write_geometry_dxf(const std::filesystem::path& path, const track::Geometry& geometry,
                                                const track::Quality* quality, const GisOptions& options = {});

}  // namespace versine::io
