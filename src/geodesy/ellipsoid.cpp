// SPDX-License-Identifier: Apache-2.0
#include "versine/geodesy/ellipsoid.hpp"

#include <cmath>
#include <numbers>

namespace versine::geodesy {

double Ellipsoid::meridian_radius(double latitude) const {
  const double s = std::sin(latitude);
  const double w2 = 1.0 - e2() * s * s;
  return a_ * (1.0 - e2()) / (w2 * std::sqrt(w2));
}

double Ellipsoid::transverse_radius(double latitude) const {
  const double s = std::sin(latitude);
  return a_ / std::sqrt(1.0 - e2() * s * s);
}

Eigen::Vector3d Ellipsoid::gravity_ned(double latitude, double height) const {
  return at(latitude, height).gravity_ned;
}

LocalEarth Ellipsoid::at(double latitude, double height) const {
  const double s = std::sin(latitude), c = std::cos(latitude), s2 = s * s;
  const double w2 = 1.0 - e2() * s2, w = std::sqrt(w2);
  const double k = b() * gamma_p_ / (a_ * gamma_e_) - 1.0;
  const double surface = gamma_e_ * (1.0 + k * s2) / w;
  const double m = omega_ * omega_ * a_ * a_ * b() / gm_;
  const double down = surface * (1.0 - 2.0 / a_ * (1.0 + f_ + m - 2.0 * f_ * s2) * height +
                                 3.0 * height * height / (a_ * a_));
  return {s, c, a_ * (1.0 - e2()) / (w2 * w), a_ / w, {-8.08e-9 * height * 2.0 * s * c, 0.0, down}};
}

Ecef Ellipsoid::to_ecef(const Geodetic& g) const {
  const double n = transverse_radius(g.latitude);
  const double cl = std::cos(g.latitude);
  return {{(n + g.height) * cl * std::cos(g.longitude), (n + g.height) * cl * std::sin(g.longitude),
           (n * (1.0 - e2()) + g.height) * std::sin(g.latitude)}};
}

Geodetic Ellipsoid::to_geodetic(const Ecef& e) const {
  const double p = std::hypot(e.r.x(), e.r.y()), z = e.r.z();
  const double ep2 = e2() / (1.0 - e2());
  // Bowring's parametric latitude, repeated: each pass reduces the error by about 1e-6 near the surface.
  double beta = std::atan2(z, (1.0 - f_) * p);
  double latitude = 0.0;
  for (int i = 0; i < 4; ++i) {
    const double sb = std::sin(beta), cb = std::cos(beta);
    latitude = std::atan2(z + ep2 * b() * sb * sb * sb, p - e2() * a_ * cb * cb * cb);
    beta = std::atan2((1.0 - f_) * std::sin(latitude), std::cos(latitude));
  }
  const double s = std::sin(latitude), c = std::cos(latitude);
  // This form of the height stays exact at the poles and at the equator.
  const double height = p * c + z * s - a_ * std::sqrt(1.0 - e2() * s * s);
  return {latitude, std::atan2(e.r.y(), e.r.x()), height};
}

Eigen::Vector3d Ellipsoid::ned_difference(const Geodetic& from, const Geodetic& to) const {
  const double dlon = std::remainder(to.longitude - from.longitude, 2.0 * std::numbers::pi);
  return {(meridian_radius(from.latitude) + from.height) * (to.latitude - from.latitude),
          (transverse_radius(from.latitude) + from.height) * std::cos(from.latitude) * dlon, from.height - to.height};
}

Geodetic Ellipsoid::displaced(const Geodetic& g, const Eigen::Vector3d& ned) const {
  return {g.latitude + ned.x() / (meridian_radius(g.latitude) + g.height),
          g.longitude + ned.y() / ((transverse_radius(g.latitude) + g.height) * std::cos(g.latitude)),
          g.height - ned.z()};
}

Eigen::Matrix3d rotation_en(double latitude, double longitude) {
  const double sl = std::sin(latitude), cl = std::cos(latitude);
  const double so = std::sin(longitude), co = std::cos(longitude);
  Eigen::Matrix3d c;
  c << -sl * co, -so, -cl * co,  //
      -sl * so, co, -cl * so,    //
      cl, 0.0, -sl;
  return c;
}

}  // namespace versine::geodesy
