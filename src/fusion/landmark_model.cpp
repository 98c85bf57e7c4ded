// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/landmark_model.hpp"

#include <cmath>

#include "versine/core/numbers.hpp"

namespace versine::fusion::landmark {

namespace {

/// Covariance that white noise of density `q` on a state collects over `dt` in that state and in the positions that
/// grow with it: `arm` is what a unit of the state moves them by over the whole step, at a constant rate.
template <class Covariance, class Arm>
void integrate_noise(Covariance& Q, double q, int state, int first_position, const Arm& arm, double dt) {
  constexpr int n = Arm::RowsAtCompileTime;
  Q.template block<n, n>(first_position, first_position) += (q * dt / 3.0) * arm * arm.transpose();
  Q.template block<n, 1>(first_position, state) += (q * dt / 2.0) * arm;
  Q.template block<1, n>(state, first_position) += (q * dt / 2.0) * arm.transpose();
  Q(state, state) += q * dt;
}

/// The same for noise on a bias that turns an angle backwards (angle' = -bias): down to position, twice integrated.
template <class Covariance, class Arm>
void integrate_bias_noise(Covariance& Q, double q, int bias, int angle, int first_position, const Arm& arm, double dt) {
  constexpr int n = Arm::RowsAtCompileTime;
  Q.template block<n, n>(first_position, first_position) += (q * dt * dt * dt / 20.0) * arm * arm.transpose();
  const Eigen::Matrix<double, n, 1> to_angle = (q * dt * dt * dt / 8.0) * arm, to_bias = (-q * dt * dt / 6.0) * arm;
  Q.template block<n, 1>(first_position, angle) += to_angle;
  Q.template block<1, n>(angle, first_position) += to_angle.transpose();
  Q.template block<n, 1>(first_position, bias) += to_bias;
  Q.template block<1, n>(bias, first_position) += to_bias.transpose();
  Q(angle, angle) += q * dt * dt * dt / 3.0;
  Q(angle, bias) -= q * dt * dt / 2.0;
  Q(bias, angle) -= q * dt * dt / 2.0;
  Q(bias, bias) += q * dt;
}

/// Variance rate (per second) of noise given per metre.
double per_second(double per_root_metre, const Motion& m) {
  return m.duration > 0.0 ? square(per_root_metre) * std::abs(m.distance) / m.duration : 0.0;
}

}  // namespace

Motion Motion::straight(double duration, double speed, double heading) {
  const Eigen::Vector2d forward(std::cos(heading), std::sin(heading));
  const double s = speed * duration, moment = 0.5 * s * duration;
  return {duration, s, moment, s * forward, moment * forward};
}

VerticalStep vertical_step(const Motion& m, const DrivingNoise& noise, const ModelNoise& model) {
  using namespace vertical;
  VerticalStep step;
  step.transition(position, pitch) = m.distance;
  // A bias turns the pitch by -w tau; what it has done to position when the step ends is the moment.
  step.transition(position, bias) = -m.distance_moment;
  step.transition(pitch, bias) = -m.duration;
  const Eigen::Matrix<double, 1, 1> arm(m.distance);
  const double q = square(noise.random_walk) + per_second(model.pitch_walk, m);
  integrate_noise(step.noise, q, pitch, position, arm, m.duration);
  const double qb = square(noise.bias_walk) + per_second(model.lateral_bias_walk, m);
  integrate_bias_noise(step.noise, qb, bias, pitch, position, arm, m.duration);
  step.noise(position, position) += square(noise.path_walk) * std::abs(m.distance);
  return step;
}

LevelStep level_step(const Motion& m, const DrivingNoise& noise, const ModelNoise& model) {
  using namespace level;
  LevelStep step;
  const Eigen::Vector2d along = m.displacement, aside(along.y(), -along.x());
  const Eigen::Vector2d aside_moment(m.displacement_moment.y(), -m.displacement_moment.x());
  step.transition.block<2, 1>(north, scale) = along;
  step.transition.block<2, 1>(north, heading) = aside;
  step.transition.block<2, 1>(north, bias) = -aside_moment;
  step.transition(heading, bias) = -m.duration;
  integrate_noise(step.noise, square(noise.scale_walk), scale, north, along, m.duration);
  const double q = square(noise.random_walk) + per_second(model.heading_walk, m);
  integrate_noise(step.noise, q, heading, north, aside, m.duration);
  const double qb = square(noise.bias_walk) + per_second(model.vertical_bias_walk, m);
  integrate_bias_noise(step.noise, qb, bias, heading, north, aside, m.duration);
  if (const double d2 = along.squaredNorm(); d2 > 0.0) {
    const double metres = std::abs(m.distance);
    step.noise.block<2, 2>(north, north) += (metres / d2) * (square(noise.path_walk) * aside * aside.transpose() +
                                                             square(noise.distance_walk) * along * along.transpose());
  }
  return step;
}

RollStep roll_step(double duration, const DrivingNoise& noise) {
  using namespace roll;
  RollStep step;
  step.transition(angle, bias) = -duration;
  const double dt = duration, q = square(noise.random_walk), qb = square(noise.bias_walk);
  step.noise(angle, angle) = q * dt + qb * dt * dt * dt / 3.0;
  step.noise(angle, bias) = step.noise(bias, angle) = -qb * dt * dt / 2.0;
  step.noise(bias, bias) = qb * dt;
  return step;
}

filter::LinearObservation<vertical::size, 1> observe_down(double z, double variance) {
  filter::LinearObservation<vertical::size, 1> o;
  o.z(0) = z;
  o.H(0, vertical::position) = 1.0;
  o.R(0, 0) = variance;
  return o;
}

filter::LinearObservation<level::size, 2> observe_level(const Eigen::Vector2d& z, const Eigen::Matrix2d& covariance) {
  filter::LinearObservation<level::size, 2> o;
  o.z = z;
  o.H.block<2, 2>(0, level::north).setIdentity();
  o.R = covariance;
  return o;
}

filter::LinearObservation<roll::size, 1> observe_roll(double z, double variance) {
  filter::LinearObservation<roll::size, 1> o;
  o.z(0) = z;
  o.H(0, roll::angle) = 1.0;
  o.H(0, roll::levelling) = 1.0;
  o.R(0, 0) = variance;
  return o;
}

}  // namespace versine::fusion::landmark
