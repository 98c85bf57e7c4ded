// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

#include "versine/simulation/body.hpp"
#include "versine/simulation/random.hpp"
#include "versine/simulation/recording.hpp"

namespace versine::simulation {

/// Increments of an IMU without errors from the body's own kinematics: the integrals of `w_ib_b` (with Earth rate) and
/// of the specific force (acceleration, Coriolis, minus gravity) over each interval, three-point Gauss quadrature.
/// `state(t)` is a BodyState at s since `start`, `w_ie_l` the Earth's rotation in the local frame, rad/s.
/// Samples at start + k / rate, k = 1 to the end.
template <class State>
[[nodiscard]] sensors::ImuSeries ideal_imu(const State& state, const Eigen::Vector3d& w_ie_l, double duration,
                                           double rate, Time start);

/// The same recording with an instrument's errors. `speed(t)` serves vibration, at s since `start`. Drawn constants and
/// the varying biases go into `truth`.
[[nodiscard]] sensors::ImuSeries with_errors(const sensors::ImuSeries& ideal, const ImuModel& model,
                                             const Temperature& temperature, const std::function<double(double)>& speed,
                                             Time start, std::uint64_t seed, Truth& truth);

template <class State>
sensors::ImuSeries ideal_imu(const State& state, const Eigen::Vector3d& w_ie_l, double duration, double rate,
                             Time start) {
  sensors::ImuSeries series;
  series.interval = Duration::from_seconds(1.0 / rate);
  const auto count = static_cast<std::size_t>(duration * rate * (1.0 + 1e-12));
  series.samples.reserve(count);
  Time before = start;
  for (std::size_t k = 1; k <= count; ++k) {
    // The stamp is a whole number of nanoseconds; the interval is exactly between two stamps.
    const Time here = start + Duration::from_seconds(static_cast<double>(k) / rate);
    const double from = (before - start).seconds(), dt = (here - before).seconds();
    sensors::ImuSample sample{here};
    constexpr double offset = 0.3872983346207417;  // sqrt(15) / 10
    for (const auto& [at, weight] :
         {std::pair{0.5 - offset, 5.0 / 18.0}, {0.5, 8.0 / 18.0}, {0.5 + offset, 5.0 / 18.0}}) {
      const BodyState s = state(from + at * dt);
      sample.dtheta += weight * dt * (s.w_lb_b + s.C_lb.transpose() * w_ie_l);
      sample.dvel += weight * dt * (s.C_lb.transpose() * (s.acceleration + 2.0 * w_ie_l.cross(s.velocity) - s.gravity));
    }
    series.samples.push_back(sample);
    before = here;
  }
  return series;
}

}  // namespace versine::simulation
