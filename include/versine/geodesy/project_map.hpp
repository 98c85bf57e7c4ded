// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "versine/geodesy/height_datum.hpp"
#include "versine/geodesy/projection.hpp"
#include "versine/geodesy/similarity.hpp"

namespace versine::geodesy {

/// From places on the Earth to the coordinates of a project (Chen 2018 section 4.4): a map projection, where the
/// project has its own grid a similarity transformation to it, and the datum of its heights.
struct ProjectMap {
  Projection projection;
  std::optional<Similarity> similarity;  ///< of easting, northing, height in the projection
  HeightDatum heights;

  /// Project coordinates, m; NaN where projection or geoid are not defined.
  [[nodiscard]] MapPoint forward(const Geodetic& place) const;
  /// Scale and convergence of the project's grid.
  [[nodiscard]] Projection::Distortion distortion(const Geodetic& place) const;
};

}  // namespace versine::geodesy
