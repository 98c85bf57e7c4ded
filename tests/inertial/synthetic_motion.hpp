// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <functional>

#include "versine/geodesy/attitude.hpp"
#include "versine/inertial/mechanization.hpp"

/// Error-free IMU increments of a known motion, made without the mechanisation: position, velocity and attitude are
/// closed forms of time, and rates and forces follow by the definitions (in double, integrated by Gauss-Legendre).
namespace versine::test {

/// A vehicle that stands, then drives on a curved, undulating way with roll and pitch: everything excited. It moves
/// along its own forward axis, as a vehicle on rails does.
struct Motion {
  geodesy::Geodetic origin{0.9, 0.2, 150.0};
  double speed = 10.0, swing = 0.0;            ///< m/s: mean, and amplitude of its variation
  double turn = 0.0, climb = 0.0, roll = 0.0;  ///< rad: amplitudes
  double period = 60.0;                        ///< s
  double still = 0.0;                          ///< s of standstill before
  Time epoch{1'700'000'000'000'000'000};

  /// Time since the start of motion, starting smoothly; it drives everything.
  [[nodiscard]] double clock(double t) const {
    const double s = t - still;
    return still == 0.0 ? t : s > 0.0 ? s * s * s / (s * s + 25.0) : 0.0;
  }
  [[nodiscard]] geodesy::Euler attitude(double t) const {
    const double w = 2.0 * M_PI / period, c = clock(t);
    return {roll * std::sin(1.3 * w * c), climb * std::sin(w * c), 0.5 + turn * std::sin(0.7 * w * c)};
  }
  [[nodiscard]] double forward(double t) const {
    const double w = 2.0 * M_PI / period, c = clock(t);
    const double ramp = still == 0.0 ? 1.0 : c * c / (c * c + 25.0);
    return ramp * (speed + swing * std::sin(w * c));
  }
  [[nodiscard]] Eigen::Vector3d velocity(double t) const { return forward(t) * geodesy::to_matrix(attitude(t)).col(0); }
  [[nodiscard]] inertial::NavState at(double t) const {
    inertial::NavState s;
    s.time = epoch + Duration::from_seconds(t);
    s.v_eb_n = velocity(t);
    s.q_nb = geodesy::to_quaternion(attitude(t));
    return s;
  }
};

/// Truth at the IMU's epochs (the first is the start) and the samples between them.
struct Recording {
  std::vector<inertial::NavState> truth;
  sensors::ImuSeries imu;
};

namespace detail {
/// Position by integrating the velocity with RK4 of small steps; returned states get their positions filled in.
inline geodesy::Geodetic advance(const Motion& m, const geodesy::Geodetic& p, double t, double dt) {
  const auto rate = [&](const geodesy::Geodetic& g, double at) -> Eigen::Vector3d {
    const Eigen::Vector3d v = m.velocity(at);
    const double rm = geodesy::wgs84.meridian_radius(g.latitude) + g.height;
    const double rn = geodesy::wgs84.transverse_radius(g.latitude) + g.height;
    return {v.x() / rm, v.y() / (rn * std::cos(g.latitude)), -v.z()};
  };
  const auto plus = [](const geodesy::Geodetic& g, const Eigen::Vector3d& d) {
    return geodesy::Geodetic{g.latitude + d.x(), g.longitude + d.y(), g.height + d.z()};
  };
  const Eigen::Vector3d k1 = rate(p, t), k2 = rate(plus(p, 0.5 * dt * k1), t + 0.5 * dt);
  const Eigen::Vector3d k3 = rate(plus(p, 0.5 * dt * k2), t + 0.5 * dt), k4 = rate(plus(p, dt * k3), t + dt);
  return plus(p, dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4));
}

/// Angular rate of b against i, b-frame, and specific force, b-frame, at time t.
inline std::pair<Eigen::Vector3d, Eigen::Vector3d> rate_and_force(const Motion& m, const geodesy::Geodetic& p,
                                                                  double t) {
  const double h = 1e-3;
  const Eigen::Quaterniond q = m.at(t).q_nb;
  // Central differences of the closed forms, fourth order.
  const auto turn = [&](double d) { return geodesy::to_rotation_vector(q.conjugate() * m.at(t + d).q_nb); };
  const Eigen::Vector3d omega_nb = (8.0 * (turn(h) - turn(-h)) - (turn(2 * h) - turn(-2 * h))) / (12.0 * h);
  const auto v = [&](double d) { return m.velocity(t + d); };
  const Eigen::Vector3d a = (8.0 * (v(h) - v(-h)) - (v(2 * h) - v(-2 * h))) / (12.0 * h);
  const geodesy::LocalEarth earth = geodesy::wgs84.at(p.latitude, p.height);
  const Eigen::Vector3d ie = inertial::earth_rate(earth, geodesy::wgs84.omega());
  const Eigen::Vector3d en = inertial::transport_rate(earth, p.height, m.velocity(t));
  const Eigen::Vector3d f_n = a - earth.gravity_ned + (2.0 * ie + en).cross(m.velocity(t));
  return {omega_nb + q.conjugate() * (ie + en), q.conjugate() * f_n};
}
}  // namespace detail

inline Recording record(const Motion& m, double duration, double rate_hz = 200.0) {
  Recording r;
  const double dt = 1.0 / rate_hz;
  r.imu.interval = Duration::from_seconds(dt);
  geodesy::Geodetic p = m.origin;
  inertial::NavState s = m.at(0.0);
  s.position = p;
  r.truth.push_back(s);
  constexpr double node[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
  constexpr double weight[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const auto n = static_cast<std::size_t>(std::llround(duration * rate_hz));
  for (std::size_t i = 0; i < n; ++i) {
    const double t = double(i) * dt;
    sensors::ImuSample sample;
    sample.time = m.epoch + Duration{r.imu.interval.ns * static_cast<std::int64_t>(i + 1)};
    for (int k = 0; k < 3; ++k) {
      const auto [omega, force] = detail::rate_and_force(m, detail::advance(m, p, t, node[k] * dt), t + node[k] * dt);
      sample.dtheta += weight[k] * dt * omega;
      sample.dvel += weight[k] * dt * force;
    }
    p = detail::advance(m, p, t, dt);
    s = m.at(t + dt);
    s.position = p;
    s.time = sample.time;
    r.truth.push_back(s);
    r.imu.samples.push_back(sample);
  }
  return r;
}

}  // namespace versine::test
