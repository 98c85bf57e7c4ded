// SPDX-License-Identifier: Apache-2.0
#include "versine/inertial/mechanization.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "versine/geodesy/attitude.hpp"

namespace versine::inertial {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Increment corrected(const sensors::ImuSample& sample, double dt, const ImuCorrection& correction) {
  const auto undo = [dt](const Vector3d& measured, const Vector3d& bias, const Vector3d& scale) -> Vector3d {
    return (measured - bias * dt).cwiseQuotient(Vector3d::Ones() + scale);
  };
  return {undo(sample.dtheta, correction.gyro_bias, correction.gyro_scale),
          undo(sample.dvel, correction.accelerometer_bias, correction.accelerometer_scale), dt};
}

Increment with_coning_and_sculling(const Increment& previous, const Increment& current) {
  if (!(previous.dt > 0.0)) return current;
  // Rate a + b t through both increments: the coning integral is a x b T^3 / 12, and the cross product of the two
  // increments is a x b T' T (T' + T) / 2.
  const double k = current.dt * current.dt / (6.0 * previous.dt * (previous.dt + current.dt));
  return {
      current.rotation + k * previous.rotation.cross(current.rotation),
      current.velocity + k * (previous.rotation.cross(current.velocity) + previous.velocity.cross(current.rotation)),
      current.dt};
}

Vector3d earth_rate(const geodesy::LocalEarth& earth, double omega) {
  return {omega * earth.cos_latitude, 0.0, -omega * earth.sin_latitude};
}

Vector3d transport_rate(const geodesy::LocalEarth& earth, double height, const Vector3d& v) {
  const double east = v.y() / (earth.transverse_radius + height);
  return {east, -v.x() / (earth.meridian_radius + height), -east * earth.sin_latitude / earth.cos_latitude};
}

namespace {
/// Integral of C_b0_b(t) over the interval for a constant rate, divided by its length, applied to `v`
/// (Groves eq. 5.84): I + (1 - cos a)/a^2 [phi x] + (a - sin a)/a^3 [phi x]^2, series below 0.1 rad (error 1e-13).
Vector3d rotated_mean(const Vector3d& phi, const Vector3d& v) {
  const double a2 = phi.squaredNorm();
  double first = 0.5 - a2 / 24.0 + a2 * a2 / 720.0, second = 1.0 / 6.0 - a2 / 120.0 + a2 * a2 / 5040.0;
  if (a2 > 0.01) {
    const double a = std::sqrt(a2);
    first = (1.0 - std::cos(a)) / a2;
    second = (a - std::sin(a)) / (a2 * a);
  }
  const Vector3d once = phi.cross(v);
  return v + first * once + second * phi.cross(once);
}

/// Quaternion of a small rotation; exact to 1e-16 below 0.03 rad by series, by sine and cosine above.
Eigen::Quaterniond small_rotation(const Vector3d& phi) {
  const double a2 = phi.squaredNorm();
  if (a2 > 1e-3) return geodesy::from_rotation_vector(phi);
  const double k = 0.5 - a2 * (1.0 / 48.0 - a2 * (1.0 / 3840.0 - a2 / 645120.0));
  const double w = 1.0 - a2 * (1.0 / 8.0 - a2 * (1.0 / 384.0 - a2 / 46080.0));
  return {w, k * phi.x(), k * phi.y(), k * phi.z()};
}
}  // namespace

NavState mechanize(const NavState& state, const Increment& increment, const geodesy::Ellipsoid& ellipsoid,
                   Matrix3d& C_nb, StepGeometry& geometry) {
  const double dt = increment.dt;
  const geodesy::LocalEarth& earth = geometry.earth = ellipsoid.at(state.position.latitude, state.position.height);
  const Vector3d omega_ie = geometry.omega_ie = earth_rate(earth, ellipsoid.omega());
  const Vector3d omega_en = transport_rate(earth, state.position.height, state.v_eb_n);

  // Velocity: the n-frame turns by zeta during the interval, by half of it on average.
  const Vector3d zeta = (omega_ie + omega_en) * dt;
  const Vector3d dv_start = C_nb * rotated_mean(increment.rotation, increment.velocity);
  const Vector3d dv = dv_start - 0.5 * zeta.cross(dv_start);
  const Vector3d predicted = state.v_eb_n + dv + earth.gravity_ned * dt;  // good enough for the middle
  geometry.v_middle = 0.5 * (state.v_eb_n + predicted);
  const double climb = -geometry.v_middle.z() * 0.5 * dt;
  geometry.omega_en = transport_rate(earth, state.position.height + climb, geometry.v_middle);
  // Gravity in the middle of the interval, by its free-air gradient.
  Vector3d gravity = earth.gravity_ned;
  gravity.z() -= 2.0 * gravity.z() / earth.meridian_radius * climb;
  const Vector3d coriolis = (2.0 * omega_ie + geometry.omega_en).cross(geometry.v_middle);

  NavState next;
  next.v_eb_n = state.v_eb_n + dv + (gravity - coriolis) * dt;
  const Vector3d v_mean = 0.5 * (state.v_eb_n + next.v_eb_n);

  // Position: height first, then the radii at the height and (to first order) the latitude in the middle.
  const double height = state.position.height, middle = height - 0.5 * v_mean.z() * dt;
  const double dlat = v_mean.x() * dt / (earth.meridian_radius + middle);
  const double cos_middle = earth.cos_latitude - 0.5 * dlat * earth.sin_latitude;
  next.position = {state.position.latitude + dlat,
                   state.position.longitude + v_mean.y() * dt / ((earth.transverse_radius + middle) * cos_middle),
                   height - v_mean.z() * dt};
  if (std::abs(next.position.longitude) > std::numbers::pi)
    next.position.longitude = geodesy::wrap_pi(next.position.longitude);

  // Attitude.
  const Vector3d turn = (omega_ie + geometry.omega_en) * dt;
  next.q_nb = small_rotation(-turn) * (state.q_nb * small_rotation(increment.rotation));
  // One Newton step keeps the norm at 1 without a square root: it never strays by more than rounding.
  next.q_nb.coeffs() *= 1.5 - 0.5 * next.q_nb.squaredNorm();
  const Matrix3d C_end = next.q_nb.toRotationMatrix();
  geometry.C_nb_middle = 0.5 * (C_nb + C_end);
  geometry.velocity_increment = dv;
  geometry.height = height;
  C_nb = C_end;
  next.time = state.time + Duration::from_seconds(dt);
  return next;
}

NavState mechanize(const NavState& state, const Increment& increment, const geodesy::Ellipsoid& ellipsoid) {
  Matrix3d C_nb = state.q_nb.toRotationMatrix();
  StepGeometry geometry;
  return mechanize(state, increment, ellipsoid, C_nb, geometry);
}

std::vector<NavState> integrate(const NavState& start, const sensors::ImuSeries& imu, const ImuCorrection& correction,
                                const geodesy::Ellipsoid& ellipsoid) {
  std::vector<NavState> states;
  NavState state = start;
  Matrix3d C_nb = state.q_nb.toRotationMatrix();
  StepGeometry geometry;
  Increment previous;
  for (std::size_t i = imu.lower_bound({start.time.ns + 1}); i < imu.size(); ++i) {
    const sensors::ImuSample& sample = imu[i];
    const Duration span = i > 0 ? sample.time - imu[i - 1].time : imu.interval;
    const Increment raw = corrected(sample, span.seconds(), correction);
    const Increment whole = with_coning_and_sculling(previous, raw);
    const Duration inside = std::min(span, sample.time - state.time);
    state = mechanize(state, part(whole, inside.seconds() / raw.dt), ellipsoid, C_nb, geometry);
    state.time = sample.time;
    previous = raw;
    states.push_back(state);
  }
  return states;
}

}  // namespace versine::inertial
