// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/planning.hpp"

#include <cmath>

#include "versine/core/numbers.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::fusion {

double cross_variance(const CrossErrors& e, double v, double T, double t) {
  const double p = square(e.start_position), s = square(e.landmark), q = square(e.random_walk);
  const double a = square(e.angle), w = square(e.bias), v2 = v * v;
  const double D = 12 * p + 12 * s + v2 * (12 * a * T * T + 4 * q * T * T * T + 3 * w * square(T * T));
  const double known_later = 12 * a * (2 * t * T - t * t) + 4 * q * (3 * t * t * T - 2 * t * t * t) +
                             3 * w * (2 * square(t * T) - square(t * t));
  const double known_before = 12 * a * t * t + 4 * q * t * t * t + 3 * w * square(t * t);
  const double bow = q * q * t * (4 * T - t) + 9 * a * w * T * T + 3 * q * T * (4 * a + w * t * T);
  return p - p * (12 * p + 12 * s + v2 * known_later) / D +
         (s * (12 * p + 12 * s + v2 * known_before) - 12 * s * s) / D + square(v2 * t * (t - T)) * bow / (3 * D);
}

double longitudinal_variance(const LongitudinalErrors& e, double v, double T, double t) {
  const double p = square(e.start_position), s = square(e.landmark);
  const double k = square(e.scale), q = square(e.scale_walk), v2 = v * v;
  const double D = 3 * p + 3 * s + v2 * (3 * k * T * T + q * T * T * T);
  const double known_later = 3 * k * (2 * t * T - t * t) + q * (3 * t * t * T - 2 * t * t * t);
  const double known_before = 3 * k * t * t + q * t * t * t;
  return p - p * (3 * p + 3 * s + v2 * known_later) / D + (s * (3 * p + 3 * s + v2 * known_before) - 3 * s * s) / D +
         q * square(v2 * t * (t - T)) * (q * t * (4 * T - t) + 12 * k * T) / (12 * D);
}

double gyrocompass_heading_error(double bias, double latitude) {
  return bias / (geodesy::wgs84.omega() * std::cos(latitude));
}

EquivalentBias equivalent_bias(double gyro_bias, double level, double heading_error, double latitude, double heading) {
  const double north = geodesy::wgs84.omega() * std::cos(latitude);
  const double down = geodesy::wgs84.omega() * std::abs(std::sin(latitude));
  const double roll_to_lateral = down * level, heading_to_lateral = north * heading_error * std::abs(std::cos(heading));
  const double roll_to_vertical = north * level * std::abs(std::sin(heading));
  const double pitch_to_vertical = north * level * std::abs(std::cos(heading));
  return {.lateral = std::hypot(gyro_bias, roll_to_lateral, heading_to_lateral),
          .vertical = std::hypot(gyro_bias, roll_to_vertical, pitch_to_vertical),
          .lateral_worst = gyro_bias + roll_to_lateral + heading_to_lateral,
          .vertical_worst = gyro_bias + roll_to_vertical + pitch_to_vertical,
          .returns_with_turn = north * heading_error};
}

}  // namespace versine::fusion
