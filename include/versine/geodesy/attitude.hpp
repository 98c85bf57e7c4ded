// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace versine::geodesy {

/// Euler angles of b against n, rad: yaw-pitch-roll (ZYX). Roll about forward, pitch about right, yaw from north
/// clockwise. `C_nb` takes a vector from b to n (EQUATIONS of docs/conventions.md).
struct Euler {
  double roll = 0.0;   ///< -pi to pi
  double pitch = 0.0;  ///< -pi/2 to pi/2
  double yaw = 0.0;    ///< -pi to pi
};

/// C_nb from Euler angles (Groves eq. 2.24).
[[nodiscard]] Eigen::Matrix3d to_matrix(const Euler& e);
[[nodiscard]] Eigen::Quaterniond to_quaternion(const Euler& e);
/// Euler angles of C_nb (Groves eq. 2.25). At pitch = +-pi/2 roll is taken as zero.
[[nodiscard]] Euler to_euler(const Eigen::Matrix3d& C_nb);
[[nodiscard]] Euler to_euler(const Eigen::Quaterniond& q_nb);

/// Cross-product matrix: skew(a) * b = a x b.
[[nodiscard]] inline Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

/// Rotation vector (axis times angle, rad) to quaternion and back; exact for any angle up to pi, series near zero.
[[nodiscard]] Eigen::Quaterniond from_rotation_vector(const Eigen::Vector3d& phi);
[[nodiscard]] Eigen::Vector3d to_rotation_vector(const Eigen::Quaterniond& q);

/// Angle wrapped to [-pi, pi].
[[nodiscard]] double wrap_pi(double angle);

}  // namespace versine::geodesy
