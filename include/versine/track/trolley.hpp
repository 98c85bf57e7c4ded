// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "versine/geodesy/attitude.hpp"

namespace versine::track {

/// Rails are left and right as seen in the direction of increasing mileage, whatever way the trolley stands.
enum class Rail { left, right };

/// A three-wheeled measuring trolley (Chen 2018 fig. 3). Frame v: origin in the IMU's reference point, x forward and
/// parallel to the line of the two fixed rollers (A1 front, A2 rear), z down and perpendicular to the plane of the
/// three wheels' contact points, y right. A1 and A2 run on the reference rail; A3, on a spring, on the other one. Each
/// roller touches the rail at the gauge corner, each wheel its running surface right above: a rail's point has the
/// lateral place of the roller and the height of the running surface.
struct Trolley {
  /// Attitude of the IMU (b) in the trolley (v): `x_v = to_matrix(mounting) * x_b`.
  geodesy::Euler mounting;
  geodesy::Euler mounting_sigma;  ///< what calibration left, rad
  double front_x = 0.6;           ///< A1, m
  double rear_x = -0.6;           ///< A2, m
  double other_x = 0.0;           ///< A3 and the gauge sensor's beam, m
  double reference_y = -0.7175;   ///< A1 and A2, m; negative: the reference rail is on the left of the trolley's x axis
  double contact_z = 0.5;         ///< running surface below the IMU, m
  double range_x = 0.0;           ///< ultrasonic sleeper sensor, m

  double gauge_offset = 1.435;            ///< d1 of Chen eq. 1: gauge at reading 0 and 0 deg C, m
  double gauge_temperature_factor = 0.0;  ///< K_T of Chen eq. 1, m per deg C
  double gauge_sigma = 0.05e-3;           ///< noise of one reading after averaging over the window, and calibration, m
  double contact_sigma = 0.05e-3;         ///< a wheel or roller against the rail (dirt, wear), m

  /// -1: the reference rail is on the left of the trolley's x axis; +1: on the right.
  [[nodiscard]] double reference_side() const { return reference_y < 0.0 ? -1.0 : 1.0; }
  /// Wheelbase d_w of Chen eq. 2.
  [[nodiscard]] double wheelbase() const { return front_x - rear_x; }
};

}  // namespace versine::track
