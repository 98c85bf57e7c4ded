// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/imu.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "versine/simulation/noise.hpp"

namespace versine::simulation {

namespace {
using Eigen::Vector3d;

/// One triad: constant errors of this run and the processes that go on.
class Triad {
 public:
  struct Given {
    std::optional<Vector3d> bias, scale;
    Vector3d temperature_factor;
    double quantum, vibration;
  };
  Triad(const std::string& name, const sensors::TriadErrors& errors, ImuModel::Instability instability,
        const Given& given, double step, double length, std::uint64_t seed, Truth& truth)
      : errors_(errors),
        given_(given),
        root_step_(std::sqrt(step)),
        white_(seed, "imu." + name + ".white"),
        slow_(seed, "imu." + name + ".slow") {
    RandomStream constant(seed, "imu." + name + ".constant");
    bias_ = errors.bias * constant.normal3();
    const Vector3d scale = errors.scale_factor * constant.normal3();
    const Vector3d skew = errors.misalignment * constant.normal3();
    if (given.bias) bias_ = *given.bias;
    matrix_.diagonal() += given.scale ? *given.scale : scale;
    matrix_(1, 0) = skew.x(), matrix_(2, 0) = skew.y(), matrix_(2, 1) = skew.z();
    for (int i = 0; i < 3; ++i) {
      const std::string axis = std::string("_") + "xyz"[i];
      truth.constants.emplace_back(name + "_bias" + axis, bias_(i));
      truth.constants.emplace_back(name + "_scale" + axis, matrix_(i, i) - 1.0);
      truth.constants.emplace_back(name + "_skew" + axis, skew(i));
      walk_.emplace_back(errors.rate_random_walk, step);
      if (instability == ImuModel::Instability::flicker) {
        flicker_.emplace_back(errors.bias_instability, step, std::max(1e5, length), slow_);
      } else {
        markov_.emplace_back(errors.bias_instability, errors.correlation_time, step, slow_);
      }
    }
  }

  /// Bias at this step; call once a step.
  Vector3d bias(double warming) {
    Vector3d b = bias_ + warming * given_.temperature_factor;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      b(axis) += markov_.empty() ? flicker_[i].next(slow_) : markov_[i].next(slow_);
      b(axis) += walk_[i].next(slow_);
    }
    return b;
  }

  Vector3d measured(const Vector3d& increment, const Vector3d& bias, double dt, double speed) {
    const double vibration = given_.vibration * speed;
    const double density = std::sqrt(errors_.random_walk * errors_.random_walk + vibration * vibration);
    Vector3d out = matrix_ * increment + bias * dt;
    if (density > 0.0) out += density * root_step_ * white_.normal3();
    if (!(given_.quantum > 0.0)) return out;
    // What a counter has not told yet it tells later.
    rest_ += out;
    const Vector3d told = (rest_ / given_.quantum).array().round() * given_.quantum;
    rest_ -= told;
    return told;
  }

 private:
  sensors::TriadErrors errors_;
  Given given_;
  double root_step_;
  RandomStream white_, slow_;
  Vector3d bias_, rest_ = Vector3d::Zero();
  Eigen::Matrix3d matrix_ = Eigen::Matrix3d::Identity();
  std::vector<GaussMarkov> markov_;
  std::vector<FlickerNoise> flicker_;
  std::vector<RandomWalk> walk_;
};
}  // namespace

sensors::ImuSeries with_errors(const sensors::ImuSeries& ideal, const ImuModel& model, const Temperature& temperature,
                               const std::function<double(double)>& speed, Time start, std::uint64_t seed,
                               Truth& truth) {
  sensors::ImuSeries out = ideal;
  const double step = ideal.interval.seconds();
  const double length = step * static_cast<double>(ideal.size());  // flicker reaches that far down
  Triad gyro(
      "gyro", model.errors.gyro, model.instability,
      {model.gyro_bias, model.gyro_scale, model.gyro_temperature_factor, model.gyro_quantum, model.vibration_gyro},
      step, length, seed, truth);
  Triad accelerometer("accel", model.errors.accelerometer, model.instability,
                      {model.accelerometer_bias, model.accelerometer_scale, model.accelerometer_temperature_factor,
                       model.accelerometer_quantum, model.vibration_accelerometer},
                      step, length, seed, truth);
  RandomStream clock(seed, "imu.clock");
  const bool vibrates = model.vibration_gyro > 0.0 || model.vibration_accelerometer > 0.0;
  Time before = start;
  const auto each_second = static_cast<std::size_t>(std::max(1.0, std::round(model.rate)));
  for (std::size_t k = 0; k < out.size(); ++k) {
    sensors::ImuSample& s = out[k];
    const double t = (s.time - start).seconds(), dt = (s.time - before).seconds();
    before = s.time;
    const double warming = temperature.at(t) - 20.0;
    const double v = vibrates ? std::abs(speed(t)) : 0.0;
    const Vector3d gyro_bias = gyro.bias(warming), accelerometer_bias = accelerometer.bias(warming);
    if (k % each_second == 0) truth.bias.samples.push_back({s.time, gyro_bias, accelerometer_bias});
    s.dtheta = gyro.measured(s.dtheta, gyro_bias, dt, v);
    s.dvel = accelerometer.measured(s.dvel, accelerometer_bias, dt, v);
    if (model.clock_drift != 0.0) s.time = s.time + Duration::from_seconds(model.clock_drift * t);
    if (model.clock_jitter > 0.0) s.time = s.time + Duration::from_seconds(model.clock_jitter * clock.normal());
  }
  return out;
}

}  // namespace versine::simulation
