// SPDX-License-Identifier: Apache-2.0
#include "online_inertial.hpp"

#include <cmath>

namespace versine::georef {

void OnlineInertial::add(const InertialSample& s, bool has_turn_rate) {
  if (!s.acceleration.allFinite() || (last_ && !(*last_ < s.time))) return;
  const double dt = last_ ? std::min((s.time - *last_).seconds(), 0.2) : 0.0;
  last_ = s.time;
  all_.add(s.acceleration);
  interval_.add(s.acceleration);
  if (stands_) {
    standing_.add(s.acceleration);
    standing_turn_.add(s.turn_rate);
  }
  seconds_ += dt;
  if (axis_) {
    const double bias = axis_->dot(standing_.n > 50 ? standing_.value : all_.value);
    const double a = axis_->dot(s.acceleration) - bias;
    force_d_ += dt * force_s_ + 0.5 * dt * dt * a;
    force_s_ += dt * a;
  }
  has_turn_ = has_turn_rate && all_.n > 100;
  if (has_turn_) {
    const Eigen::Vector3d down = -all_.value.normalized();
    turned_ += dt * (down.dot(s.turn_rate) - (standing_turn_.n > 50 ? down.dot(standing_turn_.value) : 0.0));
    turn_seconds_ += dt;
  }
}

void OnlineInertial::learn(double dv, double dt) {
  const Eigen::Vector3d level = standing_.n > 50 ? standing_.value : all_.value, up = level.normalized();
  Eigen::Vector3d force = interval_.value - level;
  force -= up * up.dot(force);
  if (!axis_) {
    moment_ += force * (dv / dt);
    speed_square_ += dv * dv;
    if (speed_square_ < 4.0 || !(moment_.norm() > 0.0)) return;
    axis_ = moment_.normalized();
    sign_ = 1.0;  // the axis was learned with it
    return;
  }
  if (sign_ != 0.0) return;
  const double a = axis_->dot(force), b = dv / dt;
  force_square_ += a * a, speed_square_ += b * b, product_ += a * b;
  const double both = std::sqrt(force_square_ * speed_square_);
  // Half a metre a second squared for two seconds, say, and agreeing.
  if (speed_square_ * dt * dt > 1.0 && std::abs(product_) > 0.8 * both) sign_ = product_ > 0.0 ? 1.0 : -1.0;
}

OnlineInertial::Step OnlineInertial::at_fix(Time time, std::optional<double> speed, bool standing) {
  if (standing && !stands_) {
    standing_ = standing_turn_ = {};
    sign_ = force_square_ = speed_square_ = product_ = 0.0;
    moment_.setZero();
  }
  stands_ = standing;
  Step step;
  // Where samples are missing for long, the sums are not those of the whole interval.
  if (axis_ && sign_ != 0.0 && seconds_ > 0.0) {
    step.usable = true;
    step.input = sign_ * Eigen::Vector2d(force_d_, force_s_);
  }
  if (has_turn_ && turn_seconds_ > 0.95) {
    step.turn = turned_;
    step.turn_seconds = turn_seconds_;
    turned_ = turn_seconds_ = 0.0;
  }
  force_d_ = force_s_ = seconds_ = 0.0;
  if (!speed) return step;
  const double dt = last_speed_ ? (time - last_speed_time_).seconds() : 0.0;
  if (last_speed_ && dt < 1.0) return step;
  if (last_speed_ && dt < 5.0 && interval_.n > 5 && !standing) learn(*speed - *last_speed_, dt);
  last_speed_ = speed, last_speed_time_ = time;
  interval_ = {};
  return step;
}

}  // namespace versine::georef
