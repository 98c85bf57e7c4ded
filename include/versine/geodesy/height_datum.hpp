// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/geodesy/projection.hpp"

namespace versine::geodesy {

/// A point whose height is known in the system of the trajectory (usually ellipsoidal) and in the one wanted.
struct HeightPoint {
  std::string name;
  double easting = 0.0, northing = 0.0;  ///< m; needed for a tilted plane only
  double measured = 0.0;                 ///< height in the trajectory's system, m
  double wanted = 0.0;                   ///< m
  double sigma = 1e-3;                   ///< of the difference, m
};

/// From the heights of the trajectory to the heights of the project. Immutable.
/// wanted = measured + offset + slope_east * (easting - centre) + slope_north * (northing - centre).
class HeightDatum {
 public:
  enum class Kind { none, offset, plane, geoid };

  /// Heights stay as they are.
  HeightDatum() = default;
  /// Weighted mean difference of one or more points.
  [[nodiscard]] static Expected<HeightDatum> offset(const std::vector<HeightPoint>& points);
  /// Tilted plane through three or more points not in a line: follows the geoid over some kilometres.
  [[nodiscard]] static Expected<HeightDatum> plane(const std::vector<HeightPoint>& points);
  /// Geoid grid that PROJ finds ("egm96_15.gtx", "de_bkg_gcg2016.tif", or a path), ellipsoidal WGS84 heights to heights
  /// above it. Fails with PROJ's reason when the grid is not there.
  [[nodiscard]] static Expected<HeightDatum> geoid(const std::string& grid);

  [[nodiscard]] Kind kind() const { return kind_; }
  /// The height wanted. `place` serves the geoid, `map` the plane. NaN outside the grid.
  [[nodiscard]] double apply(const Geodetic& place, const MapPoint& map) const;
  /// Wanted minus fitted, m, one per point in their order; empty for a geoid.
  [[nodiscard]] const std::vector<double>& residuals() const { return residuals_; }
  /// Names of points whose residual is beyond 3.29 of its own sigmas (0.1 %).
  [[nodiscard]] const std::vector<std::string>& outlying() const { return outlying_; }
  [[nodiscard]] double sigma0() const { return sigma0_; }  ///< of unit weight; NaN without redundancy
  [[nodiscard]] double sigma() const { return sigma_; }    ///< of the offset at the points' centre, m
  [[nodiscard]] double offset_value() const { return offset_; }
  [[nodiscard]] double slope_east() const { return slope_east_; }
  [[nodiscard]] double slope_north() const { return slope_north_; }
  /// For headers of exports: "offset -46.123 m from 3 points", ...
  [[nodiscard]] std::string description() const;

 private:
  [[nodiscard]] static Expected<HeightDatum> fit(const std::vector<HeightPoint>& points, Kind kind);
  struct Grid;
  Kind kind_ = Kind::none;
  double offset_ = 0.0, slope_east_ = 0.0, slope_north_ = 0.0, east_ = 0.0, north_ = 0.0;
  double sigma0_ = 0.0, sigma_ = 0.0;
  std::vector<double> residuals_;
  std::vector<std::string> outlying_;
  std::shared_ptr<const Grid> grid_;  // shared by copies; not thread-safe, as Projection
  std::string grid_name_;
};

}  // namespace versine::geodesy
