// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "versine/core/series.hpp"
#include "versine/geodesy/geodetic.hpp"

namespace versine::geodesy {

/// Symmetric 3 x 3 covariance, packed: xx, yy, zz, xy, xz, yz. float keeps 7 digits, enough for a stored sigma.
struct Covariance3 {
  float xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
  [[nodiscard]] static Covariance3 from(const Eigen::Matrix3d& m) {
    return {float(m(0, 0)), float(m(1, 1)), float(m(2, 2)), float(m(0, 1)), float(m(0, 2)), float(m(1, 2))};
  }
  [[nodiscard]] Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d m;
    m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return m;
  }
};

/// Where a body was, how fast, how it lay, and how well each is known.
struct TrajectoryPoint {
  Time time;
  Geodetic position;                                           ///< of the body frame's origin, WGS84 unless stated
  Eigen::Vector3d v_eb_n = Eigen::Vector3d::Zero();            ///< velocity relative to the Earth, n-frame, m/s
  Eigen::Quaterniond q_nb = Eigen::Quaterniond::Identity();    ///< attitude, b to n
  Covariance3 position_covariance;                             ///< n-frame, m^2
  Covariance3 velocity_covariance;                             ///< n-frame, m^2/s^2
  Covariance3 attitude_covariance;                             ///< of the phi-angle error in the n-frame, rad^2
  std::int32_t segment = 0;  ///< counts the uninterrupted pieces of the run; no value is interpolated across pieces
};

/// The common currency between navigation (fusion, landmark dead reckoning, foreign software) and track geometry.
struct Trajectory : Series<TrajectoryPoint> {
  std::string origin;  ///< what made it: "aided INS, smoothed", "landmark dead reckoning", "file.csv"
};

}  // namespace versine::geodesy
