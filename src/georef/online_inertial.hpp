// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>

#include "versine/georef/recording.hpp"

namespace versine::georef {

/// What an IMU adds between two fixes, without knowing the future: the forward axis is learned from changes of speed,
/// its sign anew after each standstill (a vehicle may run backwards), the bias at standstill.
class OnlineInertial {
 public:
  explicit OnlineInertial(const std::optional<Eigen::Vector3d>& forward_axis) : axis_(forward_axis) {
    if (axis_) axis_->normalize();
  }

  void add(const InertialSample& sample, bool has_turn_rate);

  struct Step {
    bool usable = false;                              ///< axis and sign are known
    Eigen::Vector2d input = Eigen::Vector2d::Zero();  ///< added to distance and speed
    std::optional<double> turn;                       ///< change of azimuth over `turn_seconds`, rad
    double turn_seconds = 0.0;
  };
  /// At a fix: what was summed since the one before. `speed`: over ground, where it is known.
  [[nodiscard]] Step at_fix(Time time, std::optional<double> speed, bool standing);

 private:
  struct Mean {
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    double n = 0.0;
    void add(const Eigen::Vector3d& x) { value += (x - value) / ++n; }
  };
  void learn(double dv, double dt);

  std::optional<Eigen::Vector3d> axis_;
  double sign_ = 0.0;  // 0: not known
  Mean all_, standing_, standing_turn_, interval_;
  bool stands_ = false;
  std::optional<Time> last_;
  std::optional<double> last_speed_;
  Time last_speed_time_;
  // Sums since the last fix, with the sign left open: of the specific force along the axis, and of turn about down.
  double force_d_ = 0.0, force_s_ = 0.0, seconds_ = 0.0, turned_ = 0.0, turn_seconds_ = 0.0;
  bool has_turn_ = false;
  // Evidence of this movement for the sign, and of all for the axis.
  Eigen::Vector3d moment_ = Eigen::Vector3d::Zero();
  double force_square_ = 0.0, speed_square_ = 0.0, product_ = 0.0;
};

}  // namespace versine::georef
