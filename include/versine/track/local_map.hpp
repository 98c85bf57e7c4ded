// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "versine/geodesy/local_frame.hpp"
#include "versine/geodesy/project_map.hpp"

namespace versine::track {

/// A projection near one place as a polynomial of second degree in the local frame's north, east, down: a PROJ call
/// costs microseconds, this some nanoseconds. Within 1e-8 m of PROJ up to 250 m from the origin.
class LocalMap {
 public:
  static constexpr double reach = 250.0;  ///< m

  LocalMap(const geodesy::Geodetic& origin, const geodesy::ProjectMap& projection);

  [[nodiscard]] const geodesy::LocalFrame& frame() const { return frame_; }
  /// Easting, northing, ellipsoidal height.
  [[nodiscard]] Eigen::Vector3d forward(const Eigen::Vector3d& ned) const;
  /// Map metres per metre on the ground, at the origin.
  [[nodiscard]] double scale() const { return scale_; }

 private:
  geodesy::LocalFrame frame_;
  Eigen::Vector3d value_;
  Eigen::Matrix3d slope_;
  Eigen::Matrix<double, 3, 6> curve_;  // nn, ee, dd, ne, nd, ed
  double scale_ = 1.0;
};

}  // namespace versine::track
