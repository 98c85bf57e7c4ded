// SPDX-License-Identifier: Apache-2.0
#include "versine/inertial/error_dynamics.hpp"

#include "versine/geodesy/attitude.hpp"

namespace versine::inertial {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using geodesy::skew;

namespace {
/// The slow blocks of F: everything that comes from the Earth's rotation and curvature.
struct EarthBlocks {
  Matrix3d position_position, velocity_position, velocity_velocity, attitude_position, attitude_velocity;
};

EarthBlocks earth_blocks(const geodesy::LocalEarth& earth, double height, const Vector3d& v, const Vector3d& omega_ie,
                         const Vector3d& omega_en) {
  const double rm = 1.0 / (earth.meridian_radius + height), rn = 1.0 / (earth.transverse_radius + height);
  const double tan = earth.sin_latitude / earth.cos_latitude;
  EarthBlocks f;
  // Metres in n are formed with the radii of the place, which change as the place does.
  f.position_position << -v.z() * rm, 0.0, v.x() * rm,  //
      v.y() * tan * rm, -v.z() * rn - v.x() * tan * rm, v.y() * rn, 0.0, 0.0, 0.0;
  // d omega_ie / d r and d omega_en / d r, d omega_en / d v
  Matrix3d ie_r = Matrix3d::Zero();
  ie_r(0, 0) = omega_ie.z() * rm;
  ie_r(2, 0) = -omega_ie.x() * rm;
  Matrix3d en_r;
  en_r << 0.0, 0.0, v.y() * rn * rn, 0.0, 0.0, -v.x() * rm * rm,  //
      -v.y() * rn * rm / (earth.cos_latitude * earth.cos_latitude), 0.0, -v.y() * tan * rn * rn;
  f.attitude_velocity << 0.0, rn, 0.0, -rm, 0.0, 0.0, 0.0, -tan * rn, 0.0;
  f.attitude_position = ie_r + en_r;
  const Matrix3d v_cross = skew(v);
  f.velocity_position = v_cross * (2.0 * ie_r + en_r);
  f.velocity_position(2, 2) += 2.0 * earth.gravity_ned.z() / earth.meridian_radius;  // free-air gradient
  f.velocity_velocity = v_cross * f.attitude_velocity - skew(2.0 * omega_ie + omega_en);
  return f;
}
}  // namespace

ErrorDynamics error_dynamics(const NavState& state, const Vector3d& f_b, const Vector3d& omega_b,
                             const geodesy::Ellipsoid& ellipsoid) {
  const geodesy::LocalEarth earth = ellipsoid.at(state.position.latitude, state.position.height);
  const Vector3d omega_ie = earth_rate(earth, ellipsoid.omega());
  const Vector3d omega_en = transport_rate(earth, state.position.height, state.v_eb_n);
  const EarthBlocks e = earth_blocks(earth, state.position.height, state.v_eb_n, omega_ie, omega_en);
  const Matrix3d C_nb = state.q_nb.toRotationMatrix();
  ErrorDynamics f;
  f.navigation << e.position_position, Matrix3d::Identity(), Matrix3d::Zero(),  //
      e.velocity_position, e.velocity_velocity, skew(C_nb * f_b),               //
      e.attitude_position, e.attitude_velocity, -skew(omega_ie + omega_en);
  f.sensors << Eigen::Matrix<double, 3, 12>::Zero(),                      //
      Matrix3d::Zero(), C_nb, Matrix3d::Zero(), C_nb * f_b.asDiagonal(),  //
      -C_nb, Matrix3d::Zero(), C_nb * (-omega_b).asDiagonal(), Matrix3d::Zero();
  return f;
}

void TransitionAccumulator::reset() {
  for (int i = 0; i < 9; ++i) {
    rows_[static_cast<std::size_t>(i)].setZero();
    rows_[static_cast<std::size_t>(i)][i] = 1.0;
  }
}

namespace {
using Row = TransitionAccumulator::Row;
/// to += m * from, for three rows each.
void add_product(Row* to, const Matrix3d& m, const Row* from) {
  for (int i = 0; i < 3; ++i) to[i] += m(i, 0) * from[0] + m(i, 1) * from[1] + m(i, 2) * from[2];
}
/// to += a x from, for three rows each.
void add_cross(Row* to, const Vector3d& a, const Row* from) {
  to[0] += a.y() * from[2] - a.z() * from[1];
  to[1] += a.z() * from[0] - a.x() * from[2];
  to[2] += a.x() * from[1] - a.y() * from[0];
}
}  // namespace

void TransitionAccumulator::add(const StepGeometry& g, const Increment& increment) {
  const double dt = increment.dt;
  EarthBlocks f = earth_blocks(g.earth, g.height, g.v_middle, g.omega_ie, g.omega_en);
  const std::array<Row, 9> before = rows_;
  Row *r = rows_.data(), *v = r + 3, *phi = r + 6;
  const Row *r0 = before.data(), *v0 = r0 + 3, *phi0 = r0 + 6;
  constexpr int gyro_bias = 9, accelerometer_bias = 12, gyro_scale = 15, accelerometer_scale = 18;

  // Attitude first, then velocity with the attitude in the middle, then position with the velocity in the middle: the
  // chain through which gravity turns a tilt into a displacement is exact to second order in dt.
  add_product(phi, f.attitude_position * dt, r0);
  add_product(phi, f.attitude_velocity * dt, v0);
  add_cross(phi, -dt * (g.omega_ie + g.omega_en), phi0);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      phi[i][gyro_bias + j] -= g.C_nb_middle(i, j) * dt;
      phi[i][gyro_scale + j] -= g.C_nb_middle(i, j) * increment.rotation[j];
    }
  }
  const std::array<Row, 3> phi_middle{0.5 * (phi[0] + phi0[0]), 0.5 * (phi[1] + phi0[1]), 0.5 * (phi[2] + phi0[2])};
  add_product(v, f.velocity_position * dt, r0);
  add_product(v, f.velocity_velocity * dt, v0);
  add_cross(v, g.velocity_increment, phi_middle.data());
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      v[i][accelerometer_bias + j] += g.C_nb_middle(i, j) * dt;
      v[i][accelerometer_scale + j] += g.C_nb_middle(i, j) * increment.velocity[j];
    }
  }
  add_product(r, f.position_position * dt, r0);
  for (int i = 0; i < 3; ++i) r[i] += (0.5 * dt) * (v[i] + v0[i]);
}

Eigen::Matrix<double, 9, 9> TransitionAccumulator::navigation() const {
  Eigen::Matrix<double, 9, 9> m;
  for (int i = 0; i < 9; ++i) m.row(i) = rows_[static_cast<std::size_t>(i)].head<9>().matrix().transpose();
  return m;
}

Eigen::Matrix<double, 9, 12> TransitionAccumulator::sensors() const {
  Eigen::Matrix<double, 9, 12> m;
  for (int i = 0; i < 9; ++i) m.row(i) = rows_[static_cast<std::size_t>(i)].segment<12>(9).matrix().transpose();
  return m;
}

}  // namespace versine::inertial
