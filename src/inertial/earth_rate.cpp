// SPDX-License-Identifier: Apache-2.0
#include "versine/inertial/earth_rate.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "versine/geodesy/attitude.hpp"

namespace versine::inertial {

using Eigen::Vector3d;

std::optional<EarthRate> measured_earth_rate(const sensors::ImuSeries& imu, const Interval& standing,
                                             const sensors::ImuErrors& errors) {
  constexpr double window = 1.0;  // s; an attitude each second is enough for a slope
  std::vector<Vector3d> turned;   // rotation vector from the start
  std::vector<double> time;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Vector3d force = Vector3d::Zero();
  double t = 0.0, next = window;
  for (const auto& s : imu.between({standing.from.ns + 1}, {standing.to.ns + 1})) {
    q = (q * geodesy::from_rotation_vector(s.dtheta)).normalized();
    force += q * s.dvel;
    t += imu.interval.seconds();
    if (t + 1e-9 < next) continue;
    turned.push_back(geodesy::to_rotation_vector(q));
    time.push_back(t);
    next += window;
  }
  if (turned.size() < 60) return std::nullopt;

  const auto n = static_cast<double>(turned.size());
  Vector3d mean = Vector3d::Zero(), slope = Vector3d::Zero();
  double middle = 0.0, spread = 0.0;
  for (std::size_t i = 0; i < turned.size(); ++i) mean += turned[i] / n, middle += time[i] / n;
  for (std::size_t i = 0; i < turned.size(); ++i) {
    slope += (time[i] - middle) * (turned[i] - mean);
    spread += (time[i] - middle) * (time[i] - middle);
  }
  slope /= spread;
  // Neighbouring residuals are alike: their lag-one correlation widens the slope's sigma.
  double square = 0.0, product = 0.0;
  Vector3d before = Vector3d::Zero();
  for (std::size_t i = 0; i < turned.size(); ++i) {
    const Vector3d r = turned[i] - mean - slope * (time[i] - middle);
    square += r.squaredNorm();
    product += r.dot(before);
    before = r;
  }
  const double alike = std::clamp(square > 0.0 ? product / square : 0.0, 0.0, 0.99);
  const double fit = square / (3.0 * n) * (1.0 + alike) / (1.0 - alike) / spread;
  const double walk = errors.gyro.random_walk * errors.gyro.random_walk * 1.2 / t;
  const double bias = std::hypot(errors.gyro.bias, errors.gyro.bias_instability);

  EarthRate out;
  out.omega_ib_b = slope;
  const Vector3d up = force.normalized();  // in the frame of the slope; the Earth's axis keeps its angle to it
  out.vertical = slope.dot(up);
  out.horizontal = (slope - out.vertical * up).norm();
  out.sigma = std::sqrt(fit + walk + bias * bias);
  return out;
}

}  // namespace versine::inertial
