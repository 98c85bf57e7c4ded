// SPDX-License-Identifier: Apache-2.0
#include "versine/track/local_map.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace versine::track {

LocalMap::LocalMap(const geodesy::Geodetic& origin, const geodesy::ProjectMap& projection) : frame_(origin) {
  constexpr double h = 100.0;  // step of the differences, m; the third order that is left is 1e-9 m
  const auto f = [&](const Eigen::Vector3d& ned) -> Eigen::Vector3d {
    const geodesy::Geodetic g = frame_.to_geodetic(ned);
    const geodesy::MapPoint p = projection.forward(g);
    return {p.easting, p.northing, p.height};
  };
  value_ = f(Eigen::Vector3d::Zero());
  Eigen::Vector3d plus[3];
  for (int i = 0; i < 3; ++i) {
    plus[i] = f(h * Eigen::Vector3d::Unit(i));
    const Eigen::Vector3d minus = f(-h * Eigen::Vector3d::Unit(i));
    slope_.col(i) = (plus[i] - minus) / (2.0 * h);
    curve_.col(i) = (plus[i] - 2.0 * value_ + minus) / (2.0 * h * h);
  }
  constexpr int pairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  for (int k = 0; k < 3; ++k) {
    const auto [i, j] = pairs[k];
    const Eigen::Vector3d both = f(h * (Eigen::Vector3d::Unit(i) + Eigen::Vector3d::Unit(j)));
    curve_.col(3 + k) = (both - plus[i] - plus[j] + value_) / (h * h);
  }
  scale_ = std::sqrt(std::abs(slope_.topLeftCorner<2, 2>().determinant()));
}

Eigen::Vector3d LocalMap::forward(const Eigen::Vector3d& v) const {
  Eigen::Matrix<double, 6, 1> q;
  q << v.x() * v.x(), v.y() * v.y(), v.z() * v.z(), v.x() * v.y(), v.x() * v.z(), v.y() * v.z();
  return value_ + slope_ * v + curve_ * q;
}

}  // namespace versine::track
