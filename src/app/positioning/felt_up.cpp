// SPDX-License-Identifier: Apache-2.0
#include "versine/app/felt_up.hpp"

#include <cmath>

#include "versine/core/numbers.hpp"
#include "versine/core/units.hpp"

namespace versine::app {
namespace {

constexpr double changing_bias = 0.2;                  ///< share of the bias that changes in the course of a survey
constexpr double setting = 5.0 * units::arcsec;        ///< the trolley gives under whoever works at it
constexpr double plausible_gravity = 0.02;             ///< relative
const Duration rocking = Duration::from_seconds(1.0);  ///< at both ends of a stand

}  // namespace

double felt_up_sigma(const sensors::TriadErrors& a, double seconds) {
  const double noise = square(a.random_walk) / std::max(seconds, 1e-3);
  const double acceleration = std::sqrt(noise + square(a.bias_instability) + square(changing_bias * a.bias));
  return std::hypot(acceleration / units::standard_gravity, setting);
}

void feel_up(std::span<stationing::Stationing> stationings, const sensors::ImuSeries& imu,
             const sensors::TriadErrors& accelerometer) {
  for (stationing::Stationing& s : stationings) {
    if (!s.from || !s.to) continue;
    const bool is_long = *s.to - *s.from > rocking + rocking + rocking;
    const auto samples = imu.between(is_long ? *s.from + rocking : *s.from, is_long ? *s.to - rocking : *s.to);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const sensors::ImuSample& x : samples) sum += x.dvel;
    const double seconds = static_cast<double>(samples.size()) * imu.interval.seconds();
    const double force = sum.norm() / (seconds * units::standard_gravity);
    if (!(std::abs(force - 1.0) < plausible_gravity)) continue;
    s.felt_up = {sum.normalized(), felt_up_sigma(accelerometer, seconds)};
  }
}

}  // namespace versine::app
