// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string_view>

namespace versine::sensors {

/// Stochastic errors of one triad (gyroscopes: rad, accelerometers: m/s), the same for its three axes.
/// Used alike to simulate, to filter and to plan, so that the three never disagree.
struct TriadErrors {
  double bias = 0.0;              ///< sigma of the constant bias, rad/s or m/s^2
  double random_walk = 0.0;       ///< white noise density (angle or velocity random walk), rad/sqrt(s) or m/s/sqrt(s)
  double bias_instability = 0.0;  ///< sigma of the slowly varying bias, rad/s or m/s^2
  double correlation_time = 3600.0;  ///< of that bias as a first-order Gauss-Markov process, s
  double rate_random_walk = 0.0;     ///< density of the bias's own random walk, rad/s/sqrt(s) or m/s^2/sqrt(s)
  double scale_factor = 0.0;         ///< sigma of the constant scale factor error, 1
  double misalignment = 0.0;         ///< sigma of each small angle of non-orthogonality, rad
};

struct ImuErrors {
  TriadErrors gyro;
  TriadErrors accelerometer;
};

/// A class of instrument by name, with the source of its numbers.
struct ImuGrade {
  std::string_view name;  ///< "navigation-rlg", "fog", "tactical", "mems", "perfect", ...
  std::string_view description;
  ImuErrors errors;
};

/// All grades, best first.
[[nodiscard]] std::span<const ImuGrade> imu_grades();
/// The grade of that name.
[[nodiscard]] std::optional<ImuGrade> find_imu_grade(std::string_view name);

}  // namespace versine::sensors
