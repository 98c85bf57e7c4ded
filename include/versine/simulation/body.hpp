// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>

#include "versine/simulation/motion.hpp"
#include "versine/simulation/rails.hpp"

namespace versine::simulation {

/// Attitude and place of a body in the local frame.
struct BodyPose {
  Eigen::Vector3d origin;  ///< m
  Eigen::Matrix3d axes;    ///< columns are its forward, right and down
};

/// The trolley with its beam (A3) at a distance along the axis: A1 and A2 touch the reference rail at the distance of
/// their axles, A3 the other rail where the beam meets it; the plane of the three contact points gives the attitude.
/// Exact in three dimensions, for any irregularity. `forward` is +1 or -1: which way along the axis it faces.
struct TrolleyContact {
  BodyPose pose;              ///< of frame v
  double front, rear, other;  ///< distances along the axis where A1, A2 and A3 touch, m
  double gauge;               ///< between the line of the rollers A1-A2 and roller A3, along the beam, m
};
[[nodiscard]] TrolleyContact touch(const UniformSpline<6>& rails, const track::Trolley& trolley, double distance,
                                   double forward);

/// A vehicle with its middle at a distance: the chord between the middles of both bogies.
[[nodiscard]] BodyPose ride(const UniformSpline<6>& rails, const Vehicle& vehicle, double distance, double forward);

/// What the IMU goes through at one time, local frame l unless stated.
struct BodyState {
  Eigen::Vector3d position, velocity, acceleration;  ///< of the IMU relative to the Earth, m, m/s, m/s^2
  Eigen::Matrix3d C_lb;
  Eigen::Vector3d w_lb_b;   ///< angular rate against the Earth, b-frame, rad/s
  Eigen::Vector3d gravity;  ///< m/s^2
};

/// The motion of a body along its line: pose as a smooth function of distance, so that attitude, rate and acceleration
/// at any time belong to each other exactly.
class Body {
 public:
  /// Forward: +1 or -1, which way along the line it faces. `reach` is the range of distances that it will visit.
  Body(const Rails& rails, const track::Trolley& trolley, const std::optional<Vehicle>& vehicle, double forward,
       Stretch reach);

  [[nodiscard]] BodyState at(const MotionState& motion) const;
  /// Place and attitude of the IMU only.
  [[nodiscard]] BodyPose pose(double distance) const;
  /// Path of wheels A1 and A3 along their rails, positive forward for the body, and the gauge along the beam, m.
  [[nodiscard]] Eigen::Vector3d wheels(double distance) const { return wheels_.value(distance); }
  [[nodiscard]] double forward() const { return forward_; }

 private:
  double forward_ = 1.0;
  UniformSpline<9> pose_;    ///< position, roll, pitch, yaw (continuous), gravity
  UniformSpline<3> wheels_;  ///< path of A1, path of A3, gauge
};

}  // namespace versine::simulation
