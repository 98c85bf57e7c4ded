// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

namespace versine::geodesy {

/// Position on or above an ellipsoid: latitude and longitude in rad (north, east positive), ellipsoidal height in m.
/// A double radian resolves 1.4 nm on the ground.
struct Geodetic {
  double latitude = 0.0;   ///< rad, -pi/2 to pi/2
  double longitude = 0.0;  ///< rad, -pi to pi
  double height = 0.0;     ///< m above the ellipsoid
  bool operator==(const Geodetic&) const = default;
};

/// Earth-centred Earth-fixed Cartesian coordinates, m.
struct Ecef {
  Eigen::Vector3d r = Eigen::Vector3d::Zero();
};

}  // namespace versine::geodesy
