// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::geodesy {

/// Local Cartesian frame, north-east-down at an origin, in real metres: where gauge, cant, twist and versines are
/// formed. Exact (through ECEF); the frame is tangent, so 1 km away the ground is 78 mm below its horizontal plane.
class LocalFrame {
 public:
  explicit LocalFrame(const Geodetic& origin, const Ellipsoid& ellipsoid = wgs84);

  [[nodiscard]] const Geodetic& origin() const { return origin_; }
  [[nodiscard]] Eigen::Vector3d to_ned(const Geodetic& g) const;
  [[nodiscard]] Geodetic to_geodetic(const Eigen::Vector3d& ned) const;
  /// Rotation from the n-frame at `g` to this frame.
  [[nodiscard]] Eigen::Matrix3d rotation_from(const Geodetic& g) const;

 private:
  Geodetic origin_;
  Ellipsoid ellipsoid_;
  Eigen::Vector3d r0_;
  Eigen::Matrix3d C_en_;
};

}  // namespace versine::geodesy
