// SPDX-License-Identifier: Apache-2.0
#include "versine/geodesy/attitude.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace versine::geodesy {

Eigen::Matrix3d to_matrix(const Euler& e) {
  const double sr = std::sin(e.roll), cr = std::cos(e.roll);
  const double sp = std::sin(e.pitch), cp = std::cos(e.pitch);
  const double sy = std::sin(e.yaw), cy = std::cos(e.yaw);
  Eigen::Matrix3d c;
  c << cp * cy, sr * sp * cy - cr * sy, cr * sp * cy + sr * sy,  //
      cp * sy, sr * sp * sy + cr * cy, cr * sp * sy - sr * cy,   //
      -sp, sr * cp, cr * cp;
  return c;
}

Eigen::Quaterniond to_quaternion(const Euler& e) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return AngleAxisd(e.yaw, Vector3d::UnitZ()) * AngleAxisd(e.pitch, Vector3d::UnitY()) *
         AngleAxisd(e.roll, Vector3d::UnitX());
}

Euler to_euler(const Eigen::Matrix3d& C_nb) {
  // atan2 of the cosine keeps full accuracy near +-90 degrees, where asin loses half of the digits.
  const double cos_pitch = std::hypot(C_nb(2, 1), C_nb(2, 2));
  const double pitch = std::atan2(-C_nb(2, 0), cos_pitch);
  if (cos_pitch < 1e-12) return {0.0, pitch, std::atan2(-C_nb(0, 1), C_nb(1, 1))};
  return {std::atan2(C_nb(2, 1), C_nb(2, 2)), pitch, std::atan2(C_nb(1, 0), C_nb(0, 0))};
}

Euler to_euler(const Eigen::Quaterniond& q_nb) { return to_euler(q_nb.toRotationMatrix()); }

Eigen::Quaterniond from_rotation_vector(const Eigen::Vector3d& phi) {
  const double a2 = phi.squaredNorm();
  const double a = std::sqrt(a2);
  // sin(a/2)/a; below 1e-4 rad the series is exact to 1e-18.
  const double k = a < 1e-4 ? 0.5 - a2 / 48.0 : std::sin(0.5 * a) / a;
  return {std::cos(0.5 * a), k * phi.x(), k * phi.y(), k * phi.z()};
}

Eigen::Vector3d to_rotation_vector(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * q.vec();
  const double n = v.norm();
  if (n < 1e-9) return 2.0 * v;
  return (2.0 * std::atan2(n, sign * q.w()) / n) * v;
}

double wrap_pi(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

}  // namespace versine::geodesy
