// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "versine/inertial/mechanization.hpp"

namespace versine::inertial {

/// Error dynamics of the mechanisation: phi-angle model, position error in metres in n (Chen 2018 eq. 5).
///
/// Signs, once for all: a navigation error is *estimate minus truth* (dr, dv), with `C_nb_hat = (I - [phi x]) C_nb`; a
/// sensor error state is what is still in the corrected output, *truth minus estimate* of the bias or scale factor.
///
/// Order of the rows: position, velocity, attitude. Order of the sensor columns: gyro bias, accelerometer bias, gyro
/// scale factor, accelerometer scale factor.
struct ErrorDynamics {
  Eigen::Matrix<double, 9, 9> navigation;
  Eigen::Matrix<double, 9, 12> sensors;
};

/// F at one moment. f_b: specific force, m/s^2; omega_b: rate of b against i, rad/s; omega_ie: of the ellipsoid.
[[nodiscard]] ErrorDynamics error_dynamics(const NavState& state, const Eigen::Vector3d& f_b,
                                           const Eigen::Vector3d& omega_b,
                                           const geodesy::Ellipsoid& ellipsoid = geodesy::wgs84);

/// The transition matrix over any number of mechanisation steps, multiplied up step by step (second order in dt for
/// each), so that a covariance propagated at 10 Hz loses nothing of motion at 200 Hz.
class TransitionAccumulator {
 public:
  static constexpr int columns = 24;  ///< 9 navigation, 12 sensors, 3 empty: whole vector registers
  using Row = Eigen::Array<double, columns, 1>;

  TransitionAccumulator() { reset(); }
  /// Back to the identity.
  void reset();
  /// Goes on by the step that `mechanize` described.
  void add(const StepGeometry& geometry, const Increment& increment);

  [[nodiscard]] Eigen::Matrix<double, 9, 9> navigation() const;
  [[nodiscard]] Eigen::Matrix<double, 9, 12> sensors() const;
  [[nodiscard]] const std::array<Row, 9>& rows() const { return rows_; }

 private:
  std::array<Row, 9> rows_;
};

}  // namespace versine::inertial
