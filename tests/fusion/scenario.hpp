// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <random>

#include "inertial/synthetic_motion.hpp"
#include "versine/core/units.hpp"
#include "versine/fusion/aided_ins.hpp"
#include "versine/geodesy/local_frame.hpp"

/// Recordings with known truth for the tests of the aided INS.
namespace versine::test {

struct Scenario {
  Motion motion{.speed = 8.0, .swing = 3.0, .turn = 0.8, .climb = 0.02, .roll = 0.03, .still = 30.0};
  double duration = 120.0, rate = 200.0;
  sensors::ImuErrors errors = sensors::find_imu_grade("tactical")->errors;
  Eigen::Vector3d gnss_lever{0.3, -0.2, -0.8}, wheel_lever{-0.2, 0.4, 0.5};
  double gnss_sigma = 0.02, gnss_velocity_sigma = 0.03, odometer_sigma = 0.0005, odometer_scale = 0.004;
  double gnss_shift = 0.0;  ///< s off the IMU's epochs
  bool noise = true;
};

struct Simulated {
  Recording truth;
  fusion::AidedInsInput input;
  fusion::AidedInsOptions options;
};

/// Adds sensor errors by their own model: constant bias and scale factor, white noise, a Gauss-Markov bias.
inline void spoil(sensors::ImuSeries& imu, const sensors::ImuErrors& e, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  const double dt = imu.interval.seconds();
  struct Triad {
    Eigen::Vector3d bias, scale, walk;
  };
  const auto triad = [&](const sensors::TriadErrors& t) -> Triad {
    return {std::hypot(t.bias, t.bias_instability) * vector(), t.scale_factor * vector(), Eigen::Vector3d::Zero()};
  };
  Triad g = triad(e.gyro), a = triad(e.accelerometer);
  const auto add = [&](Triad& s, const sensors::TriadErrors& t, Eigen::Vector3d& value) {
    s.bias += std::sqrt(2.0 * t.bias_instability * t.bias_instability / t.correlation_time * dt) * vector();
    value += value.cwiseProduct(s.scale) + s.bias * dt + t.random_walk * std::sqrt(dt) * vector();
  };
  for (sensors::ImuSample& s : imu.samples) {
    add(g, e.gyro, s.dtheta);
    add(a, e.accelerometer, s.dvel);
  }
}

/// Truth at any time: the closed form, with the position carried from the epoch before.
inline inertial::NavState truth_at(const Scenario& s, const Recording& r, double t) {
  const auto i = std::min(r.truth.size() - 1, static_cast<std::size_t>(t * s.rate + 1e-9));
  const double at = double(i) / s.rate;
  inertial::NavState n = s.motion.at(t);
  n.position = detail::advance(s.motion, r.truth[i].position, at, t - at);
  return n;
}

inline Simulated make(const Scenario& s, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const double k = s.noise ? 1.0 : 0.0;
  const auto vector = [&] { return Eigen::Vector3d(k * normal(random), k * normal(random), k * normal(random)); };
  Simulated run;
  run.truth = record(s.motion, s.duration, s.rate);
  run.input.imu = run.truth.imu;
  if (s.noise) spoil(run.input.imu, s.errors, random);

  for (double t = 0.5 + s.gnss_shift; t < s.duration; t += 1.0) {
    const inertial::NavState n = truth_at(s, run.truth, t);
    sensors::GnssSample g;
    g.time = n.time;
    const double h = 1e-3;
    const auto lever = [&](double x) -> Eigen::Vector3d { return s.motion.at(x).q_nb * s.gnss_lever; };
    g.position = geodesy::wgs84.displaced(n.position, lever(t) + s.gnss_sigma * vector());
    g.sigma_ned.setConstant(s.gnss_sigma);
    g.v_ned = n.v_eb_n + (lever(t + h) - lever(t - h)) / (2 * h) + s.gnss_velocity_sigma * vector();
    g.sigma_v_ned.setConstant(s.gnss_velocity_sigma);
    run.input.gnss.samples.push_back(g);
  }
  double way = 0.0;
  const int parts = 20;
  for (double t = 0.0; t < s.duration - 0.06; t += 0.05) {
    sensors::OdometerSample o;
    o.time = s.motion.epoch + Duration::from_seconds(t);
    o.distance = way + k * s.odometer_sigma * normal(random);
    run.input.odometer.samples.push_back(o);
    for (int i = 0; i < parts; ++i) {  // the way of the wheel point, along the vehicle's forward axis
      const double at = t + (i + 0.5) * 0.05 / parts, h = 1e-3;
      const Eigen::Vector3d omega =
          geodesy::to_rotation_vector(s.motion.at(at - h).q_nb.conjugate() * s.motion.at(at + h).q_nb) / (2 * h);
      way += (1.0 + k * s.odometer_scale) * (s.motion.forward(at) + omega.cross(s.wheel_lever).x()) * 0.05 / parts;
    }
  }
  fusion::AidedInsOptions& o = run.options;
  o.imu_errors = s.errors;
  o.imu_errors.gyro.misalignment = o.imu_errors.accelerometer.misalignment = 0.0;
  o.gnss_lever.l_b = s.gnss_lever;
  o.wheel_lever.l_b = s.wheel_lever;
  o.odometer_sigma = s.odometer_sigma;
  o.heading_source = fusion::HeadingSource::given;
  o.initial_heading_sigma = 0.02;
  o.initial_heading = 0.5 + o.initial_heading_sigma * k * normal(random);
  o.constraint = false;  // the wheel is not in the middle of a wheelbase here: scenarios switch it on at the IMU
  return run;
}

struct Errors {
  Eigen::Vector3d position, velocity, attitude;
};
inline Errors error_at(const geodesy::TrajectoryPoint& p, const inertial::NavState& n) {
  return {geodesy::wgs84.ned_difference(n.position, p.position), p.v_eb_n - n.v_eb_n,
          geodesy::to_rotation_vector(n.q_nb * p.q_nb.conjugate())};
}

}  // namespace versine::test
