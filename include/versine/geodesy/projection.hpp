// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "versine/core/error.hpp"
#include "versine/geodesy/geodetic.hpp"

namespace versine::geodesy {

/// Map coordinates, m: easting, northing, height (ellipsoidal unless a height datum says otherwise).
struct MapPoint {
  double easting = 0.0;
  double northing = 0.0;
  double height = 0.0;
};

/// A map projection by its PROJ definition: "EPSG:25832", a PROJ string, or WKT. Axis order is always easting,
/// northing, whatever the authority says. Not thread-safe: one object per thread (copying makes a new PROJ context).
class Projection {
 public:
  /// Fails with the definition and PROJ's own message when it is unknown.
  [[nodiscard]] static Expected<Projection> create(const std::string& definition);
  /// Gauss-Krueger: transverse Mercator on the given ellipsoid with any central meridian (rad) and scale.
  [[nodiscard]] static Expected<Projection> transverse_mercator(double central_meridian, double scale = 1.0,
                                                                double false_easting = 500000.0,
                                                                double latitude_of_origin = 0.0);
  /// The UTM zone of a place.
  [[nodiscard]] static Expected<Projection> utm(const Geodetic& place);

  Projection(const Projection& other);
  Projection& operator=(const Projection& other);
  Projection(Projection&&) noexcept;
  Projection& operator=(Projection&&) noexcept;
  ~Projection();

  /// NaN coordinates where the projection is not defined.
  [[nodiscard]] MapPoint forward(const Geodetic& g) const;
  [[nodiscard]] Geodetic inverse(const MapPoint& p) const;
  /// Map metres per metre on the ground at a place, and the angle from true north to grid north (rad, clockwise).
  struct Distortion {
    double scale = 1.0;
    double convergence = 0.0;
  };
  [[nodiscard]] Distortion distortion(const Geodetic& g) const;
  [[nodiscard]] const std::string& definition() const;
  [[nodiscard]] std::string wkt() const;

 private:
  struct Impl;
  explicit Projection(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace versine::geodesy
