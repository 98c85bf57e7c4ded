// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/body.hpp"

#include <cmath>

#include "versine/geodesy/attitude.hpp"

namespace versine::simulation {

namespace {
using Eigen::Vector3d;

Vector3d rail(const UniformSpline<6>& rails, bool left, double distance) {
  const auto p = rails.value(distance);
  return left ? Vector3d(p.head<3>()) : Vector3d(p.tail<3>());
}

/// Length of both rails from the first grid point on, by chords: 2e-8 short of the arc at R = 150 m.
class RailLengths {
 public:
  RailLengths(const UniformSpline<6>& rails, double begin, double step, std::size_t count)
      : begin_(begin), step_(step), left_(count, 0.0), right_(count, 0.0) {
    auto before = rails.value(begin);
    for (std::size_t i = 1; i < count; ++i) {
      const auto here = rails.value(begin + static_cast<double>(i) * step);
      left_[i] = left_[i - 1] + (here - before).head<3>().norm();
      right_[i] = right_[i - 1] + (here - before).tail<3>().norm();
      before = here;
    }
  }
  [[nodiscard]] double at(bool left, double distance) const {
    const std::vector<double>& lengths = left ? left_ : right_;
    const double t = std::clamp((distance - begin_) / step_, 0.0, static_cast<double>(lengths.size() - 2));
    const auto i = static_cast<std::size_t>(t);
    return lengths[i] + (t - static_cast<double>(i)) * (lengths[i + 1] - lengths[i]);
  }

 private:
  double begin_, step_;
  std::vector<double> left_, right_;
};
}  // namespace

TrolleyContact touch(const UniformSpline<6>& rails, const track::Trolley& trolley, double distance, double forward) {
  // The trolley's left is the track's left when it faces increasing distances.
  const bool left = (trolley.reference_y < 0.0) == (forward > 0.0);
  const double ahead = trolley.front_x - trolley.other_x, behind = trolley.rear_x - trolley.other_x;
  TrolleyContact c{};
  // The distance between the axles is that of the contact points; along the axis it differs by curvature and map scale.
  Vector3d a1, a2;
  double stretch = 1.0;
  for (int i = 0; i < 4; ++i) {
    c.front = distance + forward * ahead * stretch;
    c.rear = distance + forward * behind * stretch;
    a1 = rail(rails, left, c.front);
    a2 = rail(rails, left, c.rear);
    stretch *= trolley.wheelbase() / (a1 - a2).norm();
  }
  const Vector3d x = (a1 - a2).normalized();
  const double along = trolley.other_x - trolley.rear_x;
  c.other = distance;
  Vector3d a3;
  for (int i = 0; i < 5; ++i) {  // each pass reduces the miss by the curvature times the gauge: 0.01 at R = 150 m
    a3 = rail(rails, !left, c.other);
    c.other += forward * (along - (a3 - a2).dot(x));
  }
  a3 = rail(rails, !left, c.other);
  const Vector3d foot = a2 + along * x;
  const double side = trolley.reference_y < 0.0 ? 1.0 : -1.0;  // A3 is to the right of the reference rail, or left
  const Vector3d z = (side * x.cross(a3 - foot)).normalized();
  const Vector3d y = z.cross(x);
  c.gauge = (a3 - foot).norm();
  c.pose.axes << x, y, z;
  c.pose.origin = a2 - c.pose.axes * Vector3d(trolley.rear_x, trolley.reference_y, trolley.contact_z);
  return c;
}

BodyPose ride(const UniformSpline<6>& rails, const Vehicle& vehicle, double distance, double forward) {
  // Each bogie takes the mean of its four wheels.
  const auto bogie = [&](double at) -> Eigen::Matrix<double, 6, 1> {
    return 0.5 * (rails.value(at + 0.5 * vehicle.axle_distance) + rails.value(at - 0.5 * vehicle.axle_distance));
  };
  const auto front = bogie(distance + forward * 0.5 * vehicle.bogie_distance);
  const auto rear = bogie(distance - forward * 0.5 * vehicle.bogie_distance);
  const Vector3d middle_front = 0.5 * (front.head<3>() + front.tail<3>());
  const Vector3d middle_rear = 0.5 * (rear.head<3>() + rear.tail<3>());
  const Vector3d across = forward * (front.tail<3>() - front.head<3>() + rear.tail<3>() - rear.head<3>());
  BodyPose pose;
  const Vector3d x = (middle_front - middle_rear).normalized();
  const Vector3d z = x.cross(across).normalized();
  pose.axes << x, z.cross(x), z;
  pose.origin = 0.5 * (middle_front + middle_rear) + pose.axes * vehicle.imu;
  return pose;
}

Body::Body(const Rails& rails, const track::Trolley& trolley, const std::optional<Vehicle>& vehicle, double forward,
           Stretch reach)
    : forward_(forward) {
  // The grid of the rails, so that a body on the same rails has the same curve whatever its reach.
  const double step = rails.step;
  const double room = step * static_cast<double>(UniformSpline<9>::margin);
  const double begin = std::floor((reach.from - room) / step) * step;
  const auto count = static_cast<std::size_t>(std::ceil((reach.to + room - begin) / step)) + 1;
  const RailLengths lengths(rails.curve, begin - 20.0 * step, step, count + 40);
  const Eigen::Matrix3d C_vb = geodesy::to_matrix(vehicle ? vehicle->mounting : trolley.mounting);
  const bool left = (trolley.reference_y < 0.0) == (forward > 0.0);

  UniformSpline<9>::Samples poses(9, static_cast<Eigen::Index>(count));
  UniformSpline<3>::Samples wheels(3, static_cast<Eigen::Index>(count));
  double yaw = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double s = begin + static_cast<double>(k) * step;
    const auto col = static_cast<Eigen::Index>(k);
    BodyPose pose;
    if (vehicle) {
      pose = ride(rails.curve, *vehicle, s, forward);
      wheels.col(col) << forward * lengths.at(true, s), forward * lengths.at(false, s), 0.0;
    } else {
      const TrolleyContact c = touch(rails.curve, trolley, s, forward);
      pose = c.pose;
      wheels.col(col) << forward * lengths.at(left, c.front), forward * lengths.at(!left, c.other), c.gauge;
    }
    const geodesy::Euler e = geodesy::to_euler(Eigen::Matrix3d(pose.axes * C_vb));
    yaw = k == 0 ? e.yaw : yaw + geodesy::wrap_pi(e.yaw - yaw);
    const geodesy::Geodetic g = rails.frame.to_geodetic(pose.origin);
    poses.col(col) << pose.origin, e.roll, e.pitch, yaw,
        rails.frame.rotation_from(g) * geodesy::wgs84.gravity_ned(g.latitude, g.height);
  }
  pose_ = UniformSpline<9>(begin, step, std::move(poses));
  wheels_ = UniformSpline<3>(begin, step, std::move(wheels));
}

BodyState Body::at(const MotionState& m) const {
  const auto jet = pose_.jet(m.distance);
  BodyState s;
  s.position = jet.value.head<3>();
  s.velocity = jet.first.head<3>() * m.speed;
  s.acceleration = jet.second.head<3>() * (m.speed * m.speed) + jet.first.head<3>() * m.acceleration;
  s.gravity = jet.value.tail<3>();
  const geodesy::Euler e{jet.value(3), jet.value(4), jet.value(5)};
  s.C_lb = geodesy::to_matrix(e);
  const double roll = jet.first(3) * m.speed, pitch = jet.first(4) * m.speed, yaw = jet.first(5) * m.speed;
  const double sr = std::sin(e.roll), cr = std::cos(e.roll), cp = std::cos(e.pitch);
  // Euler rates to body rates: third row of C_lb is (-sin pitch, sin roll cos pitch, cos roll cos pitch).
  s.w_lb_b = {roll + yaw * s.C_lb(2, 0), pitch * cr + yaw * sr * cp, -pitch * sr + yaw * cr * cp};
  return s;
}

BodyPose Body::pose(double distance) const {
  const auto v = pose_.value(distance);
  return {v.head<3>(), geodesy::to_matrix({v(3), v(4), v(5)})};
}

}  // namespace versine::simulation
