// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/geodesy/projection.hpp"

namespace versine::app {

/// Groups of points, as the page draws them: lines, or fixes of one status. Little-endian: float64 origin easting and
/// northing, uint32 groups, uint32 points, uint32 start[groups + 1], then float32 easting and northing of each point
/// from the origin (2 cm at 300 km).
[[nodiscard]] std::string encode_points(const std::vector<std::vector<Eigen::Vector2d>>& groups);

/// A railway map at three levels of detail: as it is, within 40 m and within 200 m, for pixels of up to 25 m, 120 m and
/// beyond.
struct ViewNetwork {
  std::vector<std::string> names;     ///< of the lines at full detail
  std::array<std::string, 3> levels;  ///< encode_points
  std::array<double, 4> bounds{};     ///< least easting, northing, greatest easting, northing
};
[[nodiscard]] Expected<ViewNetwork> read_view_network(const std::filesystem::path& geojson,
                                                      const geodesy::Projection& projection);

}  // namespace versine::app
