// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <vector>

#include "versine/design/assemble.hpp"
#include "versine/design/optimal_axis.hpp"

namespace versine::io {

/// Every alignment of a LandXML 1.2 file (Inframodel too), audited. Read: CoordGeom with Line, Curve and Spiral,
/// ProfAlign (the first of several), CantStation, StaEquation, Units, CoordinateSystem. Coordinates are northing,
/// easting; headings come from the points, since exporters write directions in several conventions; cant in mm is
/// recognised by its size. Fails with file and line when it is no LandXML or holds no alignment; what is wrong with one
/// alignment is in its own `alignment` and leaves the others usable.
[[nodiscard]] Expected<std::vector<design::Imported>> read_landxml(const std::filesystem::path& path,
                                                                   const design::AuditLimits& limits = {});

/// Writes LandXML 1.2, metres and radians, read back by `read_landxml` within 1e-6 m. Fails when the file can't be
/// written, or on a transition from right to left in one element, which LandXML has no words for (a clothoid is split).
[[nodiscard]] Expected<void> write_landxml(const std::filesystem::path& path,
                                           std::span<const design::Alignment> alignments);

/// A measured axis, with the standard deviations of its elements as `<Feature code="standard deviation">` with a
/// `<Property label value>` for each: start_m, length_m, radius_m, cant_m of an element; gradient_N (1), station_N_m,
/// curve_N_m of the profile's N-th gradient and of the point that it begins at. Programs that do not know them skip
/// them.
[[nodiscard]] Expected<void> write_landxml(const std::filesystem::path& path, const design::OptimalAxis& axis);

}  // namespace versine::io
