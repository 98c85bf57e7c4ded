// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/geodesy/geodetic.hpp"

namespace versine::geodesy {

/// What navigation needs of the Earth at one place; from one sine and cosine of the latitude.
struct LocalEarth {
  double sin_latitude = 0.0, cos_latitude = 1.0;
  double meridian_radius = 0.0;    ///< m
  double transverse_radius = 0.0;  ///< m
  Eigen::Vector3d gravity_ned = Eigen::Vector3d::Zero();  ///< m/s^2, see Ellipsoid::gravity_ned
};

/// A rotating reference ellipsoid with its normal gravity field. Immutable; WGS84 and GRS80 are given.
/// Source of the formulas: Moritz 1980 (Geodetic Reference System 1980); Groves 2013 ch. 2.
class Ellipsoid {
 public:
  /// a: equatorial radius, m; f: flattening; gm: m^3/s^2; omega: rad/s.
  constexpr Ellipsoid(double a, double f, double gm, double omega, double gravity_equator, double gravity_pole)
      : a_(a), f_(f), gm_(gm), omega_(omega), gamma_e_(gravity_equator), gamma_p_(gravity_pole) {}

  [[nodiscard]] constexpr double a() const { return a_; }
  [[nodiscard]] constexpr double f() const { return f_; }
  [[nodiscard]] constexpr double b() const { return a_ * (1.0 - f_); }
  [[nodiscard]] constexpr double e2() const { return f_ * (2.0 - f_); }  ///< first eccentricity squared
  [[nodiscard]] constexpr double omega() const { return omega_; }        ///< rotation rate, rad/s

  /// Radius of curvature in the meridian, m (Groves eq. 2.105).
  [[nodiscard]] double meridian_radius(double latitude) const;
  /// Radius of curvature in the prime vertical, m (Groves eq. 2.106).
  [[nodiscard]] double transverse_radius(double latitude) const;

  /// Normal gravity in the n-frame (north, east, down), m/s^2: Somigliana at the surface, second-order free-air
  /// reduction with height (Moritz 1980), and the northward lean of the normal plumb line,
  /// -8.08e-9 /s^2 * h * sin(2 latitude) (Groves eq. 2.140): 0.07 arc-seconds at 420 m.
  /// Valid from -10 km to 20 km; there within 1e-6 m/s^2 of the closed formula in height.
  [[nodiscard]] Eigen::Vector3d gravity_ned(double latitude, double height) const;

  /// Radii and gravity together: what a mechanisation asks for at every sample.
  [[nodiscard]] LocalEarth at(double latitude, double height) const;

  /// Exact.
  [[nodiscard]] Ecef to_ecef(const Geodetic& g) const;
  /// Within 1e-9 m for heights from -100 km to 1000 km (Bowring's start, iterated to convergence).
  [[nodiscard]] Geodetic to_geodetic(const Ecef& e) const;

  /// Displacement in m (north, east, down) at `from` that leads to `to`, along the curves of latitude, longitude and
  /// height: to first order in the difference, for differences of metres.
  [[nodiscard]] Eigen::Vector3d ned_difference(const Geodetic& from, const Geodetic& to) const;
  /// `g` moved by a small displacement in m (north, east, down).
  [[nodiscard]] Geodetic displaced(const Geodetic& g, const Eigen::Vector3d& ned) const;

 private:
  double a_, f_, gm_, omega_, gamma_e_, gamma_p_;
};

inline constexpr Ellipsoid wgs84{6378137.0,        1.0 / 298.257223563, 3.986004418e14,
                                 7.292115e-5,      9.7803253359,        9.8321849379};
inline constexpr Ellipsoid grs80{6378137.0,        1.0 / 298.257222101, 3.986005e14,
                                 7.292115e-5,      9.7803267715,        9.8321863685};

/// Rotation C_en (takes a vector from n to e; columns are north, east, down at that place).
[[nodiscard]] Eigen::Matrix3d rotation_en(double latitude, double longitude);

}  // namespace versine::geodesy
