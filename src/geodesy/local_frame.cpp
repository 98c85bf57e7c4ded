// SPDX-License-Identifier: Apache-2.0
#include "versine/geodesy/local_frame.hpp"

namespace versine::geodesy {

LocalFrame::LocalFrame(const Geodetic& origin, const Ellipsoid& ellipsoid)
    : origin_(origin),
      ellipsoid_(ellipsoid),
      r0_(ellipsoid.to_ecef(origin).r),
      C_en_(rotation_en(origin.latitude, origin.longitude)) {}

Eigen::Vector3d LocalFrame::to_ned(const Geodetic& g) const {
  return C_en_.transpose() * (ellipsoid_.to_ecef(g).r - r0_);
}

Geodetic LocalFrame::to_geodetic(const Eigen::Vector3d& ned) const {
  return ellipsoid_.to_geodetic({r0_ + C_en_ * ned});
}

Eigen::Matrix3d LocalFrame::rotation_from(const Geodetic& g) const {
  return C_en_.transpose() * rotation_en(g.latitude, g.longitude);
}

}  // namespace versine::geodesy
