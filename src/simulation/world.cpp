// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/world.hpp"

#include <algorithm>
#include <numbers>

#include "versine/geodesy/attitude.hpp"

namespace versine::simulation {

double Temperature::at(double seconds) const {
  return start + rate * seconds + amplitude * std::sin(2.0 * std::numbers::pi * seconds / period);
}

const Piece& World::piece_at(double t) const {
  const auto next =
      std::upper_bound(pieces.begin(), pieces.end(), t, [](double x, const Piece& p) { return x < p.begin; });
  return next == pieces.begin() ? pieces.front() : *std::prev(next);
}

MotionState World::motion(double t) const {
  const Piece& piece = piece_at(t);
  MotionState m = piece.motion.at(t - piece.begin);
  m.speed *= piece.body.forward();
  m.acceleration *= piece.body.forward();
  return m;
}

BodyState World::state(double t) const {
  const Piece& piece = piece_at(t);
  return piece.body.at(piece.motion.at(t - piece.begin));
}

Eigen::Matrix3d World::C_lv(double t) const {
  const Piece& piece = piece_at(t);
  return piece.body.pose(piece.motion.at(t - piece.begin).distance).axes *
         geodesy::to_matrix(trolley.mounting).transpose();
}

Eigen::Vector3d World::point(double t, const Eigen::Vector3d& from_imu_v) const {
  const Piece& piece = piece_at(t);
  const BodyPose pose = piece.body.pose(piece.motion.at(t - piece.begin).distance);
  return pose.origin + pose.axes * (geodesy::to_matrix(trolley.mounting).transpose() * from_imu_v);
}

Eigen::Vector3d World::w_ie_l() const {
  const geodesy::Geodetic& origin = frame.origin();
  return geodesy::rotation_en(origin.latitude, origin.longitude).transpose() *
         Eigen::Vector3d(0.0, 0.0, geodesy::wgs84.omega());
}

}  // namespace versine::simulation
