// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/planning_methods.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "versine/core/numbers.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/inertial/error_dynamics.hpp"

namespace versine::fusion {

namespace {

/// States of the inertial methods.
constexpr int position = 0, velocity = 3, attitude = 6, gyro_bias = 9, accelerometer_bias = 12, scale = 15,
              mounting_pitch = 16, mounting_heading = 17, states = 18;
using Matrix = Eigen::Matrix<double, states, states>;
using Step = filter::LinearStep<states, 3>;

inertial::NavState state_of(const PlanCase& plan) {
  inertial::NavState s;
  s.position = {plan.latitude, 0.0, 0.0};
  s.q_nb = Eigen::Quaterniond(Eigen::AngleAxisd(plan.heading, Eigen::Vector3d::UnitZ()));
  return s;
}

/// Dynamics at constant speed, or standing.
Matrix dynamics(const PlanCase& plan, double speed) {
  inertial::NavState s = state_of(plan);
  s.v_eb_n = speed * Eigen::Vector3d(std::cos(plan.heading), std::sin(plan.heading), 0.0);
  const Eigen::Vector3d f_b = -(s.q_nb.conjugate() * geodesy::wgs84.gravity_ned(plan.latitude, 0.0));
  const Eigen::Vector3d omega_b =
      s.q_nb.conjugate() *
      Eigen::Vector3d(geodesy::wgs84.omega() * Eigen::Vector3d(std::cos(plan.latitude), 0.0, -std::sin(plan.latitude)));
  const inertial::ErrorDynamics d = inertial::error_dynamics(s, f_b, omega_b);
  Matrix F = Matrix::Zero();
  F.topLeftCorner<9, 9>() = d.navigation;
  F.block<9, 6>(0, gyro_bias) = d.sensors.leftCols<6>();
  return F;
}

Matrix density(const PlanCase& plan) {
  const auto walk = [](const sensors::TriadErrors& e) {
    return square(e.rate_random_walk) + 2.0 * square(e.bias_instability) / e.correlation_time;
  };
  Matrix Q = Matrix::Zero();
  Q.diagonal().segment<3>(velocity).setConstant(square(plan.accelerometer.random_walk));
  Q.diagonal().segment<3>(attitude).setConstant(square(plan.gyro.random_walk));
  // A little drift keeps the covariances of constant states invertible in the smoother.
  const auto floor = [](double drift, double bias) { return std::max(drift, 1e-12 * bias * bias); };
  Q.diagonal().segment<3>(gyro_bias).setConstant(floor(walk(plan.gyro), plan.gyro.bias));
  Q.diagonal().segment<3>(accelerometer_bias).setConstant(floor(walk(plan.accelerometer), plan.accelerometer.bias));
  Q(scale, scale) = square(plan.scale_walk);
  Q(mounting_pitch, mounting_pitch) = Q(mounting_heading, mounting_heading) = 1e-12 * square(plan.level);
  return Q;
}

/// Covariance after alignment: level errors follow from the accelerometers' biases and heading from the gyros', as
/// standing still demands (no horizontal acceleration, no rotation about the levelled axes).
Matrix aligned(const PlanCase& plan) {
  const Matrix F = dynamics(plan, 0.0);
  Matrix P = Matrix::Zero();
  P.diagonal().segment<3>(position).setConstant(square(plan.landmark));
  P.diagonal().segment<3>(velocity).setConstant(square(1e-4));
  P.diagonal().segment<3>(gyro_bias).setConstant(square(plan.gyro.bias));
  P.diagonal().segment<3>(accelerometer_bias).setConstant(square(plan.accelerometer.bias));
  P(scale, scale) = square(plan.scale);
  P(mounting_pitch, mounting_pitch) = P(mounting_heading, mounting_heading) = square(plan.level);
  Matrix J = Matrix::Identity();
  // Level: F_v,phi phi = -F_v,b b over the horizontal components.
  const Eigen::Matrix2d tilt = F.block<2, 2>(velocity, attitude);
  const Eigen::Matrix<double, 2, 3> level = -tilt.inverse() * F.block<2, 3>(velocity, accelerometer_bias);
  J.block<2, 3>(attitude, accelerometer_bias) = level;
  // Heading: the east component of the rotation vanishes.
  const double north = F(attitude + 1, attitude + 2);
  J.block<1, 3>(attitude + 2, gyro_bias) = -F.block<1, 3>(attitude + 1, gyro_bias) / north;
  J.block<1, 3>(attitude + 2, accelerometer_bias) = -F.block<1, 2>(attitude + 1, attitude) * level / north;
  const Matrix aligned_P = J * P * J.transpose();
  Matrix result = aligned_P;
  result.diagonal().segment<3>(attitude).array() += square(1e-6);  // noise of the alignment itself
  return result;
}

Step propagate(const Matrix& F, const Matrix& G, double dt) {
  Step step;
  const Matrix Fdt = F * dt;
  step.transition = Matrix::Identity() + Fdt + 0.5 * Fdt * Fdt;
  step.noise = 0.5 * dt * (step.transition * G * step.transition.transpose() + G);
  return step;
}

/// Velocity of the wheels in the trolley's frame: odometer with scale error ahead, nothing sideways and down.
filter::LinearObservation<states, 3> observe_wheels(const PlanCase& plan, double speed, double dt) {
  const Eigen::Matrix3d C_bn = state_of(plan).q_nb.conjugate().toRotationMatrix();
  const Eigen::Vector3d v = speed * C_bn.transpose().col(0);
  filter::LinearObservation<states, 3> o;
  o.H.block<3, 3>(0, velocity) = C_bn;
  // v_b = C_bn (I + [phi x]) (v + dv) by the phi-angle: estimate minus truth is C_bn (dv - v x phi).
  o.H.block<3, 3>(0, attitude) = -C_bn * geodesy::skew(v);
  o.H(0, scale) = -speed;
  o.H(1, mounting_heading) = speed;
  o.H(2, mounting_pitch) = -speed;
  // Noise as a random walk of position per metre; the floor is a micrometre per root second.
  const auto variance = [&](double walk) { return (square(walk) * std::abs(speed) + square(1e-6)) / dt; };
  o.R.diagonal() << variance(plan.distance_walk), variance(plan.path_walk), variance(plan.path_walk);
  return o;
}

MethodAccuracy inertial_accuracy(const PlanCase& plan, bool odometer) {
  MethodAccuracy a{.method = odometer ? PlanMethod::ins_odometer_landmark : PlanMethod::ins_landmark};
  const double step_s = std::min(0.5, plan.spacing / plan.speed / 20.0);
  const int per_interval = static_cast<int>(std::ceil(plan.spacing / plan.speed / step_s));
  const double dt = plan.spacing / plan.speed / per_interval;
  const Matrix F = dynamics(plan, plan.speed), G = density(plan);
  Step moving = propagate(F, G, dt), standing = propagate(dynamics(plan, 0.0), G, std::max(plan.stand, 1e-3));
  if (odometer) moving.observation = observe_wheels(plan, plan.speed, dt);
  filter::LinearObservation<states, 3> stop;  // a standing trolley shows its velocity, with or without odometer
  stop.H.block<3, 3>(0, velocity).setIdentity();
  stop.R = square(1e-4) * Eigen::Matrix3d::Identity();
  filter::LinearObservation<states, 3> tie;
  tie.H.block<3, 3>(0, position).setIdentity();
  tie.R = square(plan.landmark) * Eigen::Matrix3d::Identity();

  std::vector<Step> steps(1);
  std::vector<double> distance{0.0};
  double at = 0.0;
  for (int i = 0; i < plan.intervals; ++i) {
    for (int k = 0; k < per_interval; ++k) {
      steps.push_back(moving);
      distance.push_back(at += dt * plan.speed);
    }
    steps.push_back({.observation = tie});
    distance.push_back(at);
    if (plan.stand > 0.0 && i + 1 < plan.intervals) {
      steps.push_back(standing);
      steps.back().observation = stop;
      distance.push_back(at);
    }
  }
  const std::span<const Step> span(steps);
  filter::Estimate<states> start;
  start.covariance = aligned(plan);
  const auto forward = filter::filter_forward(start, span);
  const auto smoothed = filter::smooth_rts(span, std::span<const filter::ForwardEpoch<states, 3>>(forward));
  const Eigen::Vector2d along(std::cos(plan.heading), std::sin(plan.heading)), aside(-along.y(), along.x());
  const double middle = plan.spacing * (plan.intervals / 2);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Eigen::Matrix2d P = smoothed[k].estimate.covariance.topLeftCorner<2, 2>();
    const Directions sigma{std::sqrt(aside.dot(P * aside)), std::sqrt(smoothed[k].estimate.covariance(2, 2)),
                           std::sqrt(along.dot(P * along))};
    a.profile.push_back({distance[k], sigma});
    if (distance[k] >= middle - 1e-6 && distance[k] <= middle + plan.spacing + 1e-6) {
      a.worst_interior.lateral = std::max(a.worst_interior.lateral, sigma.lateral);
      a.worst_interior.vertical = std::max(a.worst_interior.vertical, sigma.vertical);
      a.worst_interior.longitudinal = std::max(a.worst_interior.longitudinal, sigma.longitudinal);
    }
  }
  return a;
}

}  // namespace

const char* to_string(PlanMethod method) {
  switch (method) {
    case PlanMethod::ins_landmark:
      return "INS/landmark";
    case PlanMethod::ins_odometer_landmark:
      return "INS/odometer/landmark";
    case PlanMethod::landmark_reckoning:
      return "gyro/odometer/landmark";
  }
  return "";
}

MethodAccuracy method_accuracy(const PlanCase& plan, PlanMethod method) {
  if (method != PlanMethod::landmark_reckoning)
    return inertial_accuracy(plan, method == PlanMethod::ins_odometer_landmark);
  ChainAccuracy chain = chain_accuracy(plan, 0.0);
  return {method, std::move(chain.profile), chain.worst_interior};
}

}  // namespace versine::fusion
