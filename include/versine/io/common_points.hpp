// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/geodesy/height_datum.hpp"
#include "versine/geodesy/similarity.hpp"
#include "versine/io/recording_description.hpp"

namespace versine::io {

/// Points known both as the trajectory sees them (`source`: map coordinates in the job's CRS, ellipsoidal height) and
/// in the project's grid and height datum (`target`).
struct CommonPoints {
  std::vector<geodesy::CommonPoint> plane;   ///< those with coordinates; z is 0 where a height is missing
  std::vector<geodesy::HeightPoint> height;  ///< those with both heights
};

/// CSV: name, easting_m, northing_m, height_m, project_easting_m, project_northing_m, project_height_m, sigma_mm.
/// Either kind of coordinates may be missing, columns or fields; sigma is 1 mm then. Fails on a row with half a pair.
[[nodiscard]] Expected<CommonPoints> read_common_points(const TableFile& file);

/// Residuals of the common points after the fit, and which were left out. `similarity` may be null, `points` empty.
[[nodiscard]] Expected<void> write_common_points_csv(const std::filesystem::path& path,
                                                     const geodesy::Similarity* similarity,
                                                     const geodesy::HeightDatum& heights,
                                                     const std::vector<geodesy::HeightPoint>& points);

}  // namespace versine::io
