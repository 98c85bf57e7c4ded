// SPDX-License-Identifier: Apache-2.0
#include "versine/inertial/earth_rate.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::inertial {

using Eigen::Vector3d;

namespace {
/// Variance of sum(weight * residual) of a series whose neighbours are alike: its own autocovariance up to an eighth of
/// its length, with falling weights so that the sum stays positive (Newey and West 1987).
double variance_of_sum(const std::vector<double>& weighted) {
  const std::size_t n = weighted.size(), lags = n / 8;
  double sum = 0.0;
  for (std::size_t k = 0; k <= lags; ++k) {
    double product = 0.0;
    for (std::size_t i = k; i < n; ++i) product += weighted[i] * weighted[i - k];
    sum += (k == 0 ? 1.0 : 2.0 * (1.0 - static_cast<double>(k) / static_cast<double>(lags + 1))) * product;
  }
  return sum;
}

/// Rotation vectors, each second, of a level frame that goes with the vehicle, from the frame of its start. The gyros
/// carry the body in inertial space, the specific force of the second tells how it leans: what is left turns with the
/// ground, whatever the springs do.
struct LevelFrames {
  std::vector<Vector3d> turned;
  std::vector<double> time;
  Vector3d up = Vector3d::Zero();  ///< in the frame of the start
  double seconds = 0.0;
};

LevelFrames level_frames(const sensors::ImuSeries& imu, const Interval& standing) {
  constexpr double window = 1.0;  // s; an attitude each second is enough for a slope
  LevelFrames out;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Vector3d force = Vector3d::Zero();
  double next = window;
  for (const auto& s : imu.between({standing.from.ns + 1}, {standing.to.ns + 1})) {
    const Eigen::Quaterniond half = geodesy::from_rotation_vector(0.5 * s.dtheta);
    force += (q * half) * s.dvel;
    q = (q * half * half).normalized();
    out.seconds += imu.interval.seconds();
    if (out.seconds + 1e-9 < next) continue;
    const Vector3d up_b = (q.conjugate() * force).normalized();
    if (out.turned.empty()) out.up = up_b;
    out.turned.push_back(geodesy::to_rotation_vector(q * Eigen::Quaterniond::FromTwoVectors(out.up, up_b)));
    out.time.push_back(out.seconds);
    force.setZero();
    next += window;
  }
  return out;
}
}  // namespace

std::optional<EarthRate> measured_earth_rate(const sensors::ImuSeries& imu, const Interval& standing,
                                             const sensors::ImuErrors& errors) {
  const LevelFrames frames = level_frames(imu, standing);
  const std::size_t n = frames.turned.size();
  if (n < 60) return std::nullopt;
  Vector3d mean = Vector3d::Zero(), slope = Vector3d::Zero();
  double middle = 0.0, spread = 0.0;
  for (std::size_t i = 0; i < n; ++i) mean += frames.turned[i], middle += frames.time[i];
  mean /= static_cast<double>(n);
  middle /= static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) {
    slope += (frames.time[i] - middle) * (frames.turned[i] - mean);
    spread += (frames.time[i] - middle) * (frames.time[i] - middle);
  }
  slope /= spread;
  double fit = 0.0;  // of the worst axis
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> weighted(n);
    for (std::size_t i = 0; i < n; ++i) {
      const double t = frames.time[i] - middle;
      weighted[i] = t / spread * (frames.turned[i][axis] - mean[axis] - slope[axis] * t);
    }
    fit = std::max(fit, variance_of_sum(weighted));
  }
  const double walk = errors.gyro.random_walk * errors.gyro.random_walk * 1.2 / frames.seconds;
  const double bias = std::hypot(errors.gyro.bias, errors.gyro.bias_instability);

  EarthRate out;
  out.omega_ib_b = slope;
  out.vertical = slope.dot(frames.up);
  out.horizontal = (slope - out.vertical * frames.up).norm();
  out.sigma = std::sqrt(fit + walk + bias * bias);
  return out;
}

Expected<void> check_latitude(const EarthRate& rate, const geodesy::Geodetic& place, const std::string& file) {
  const double sigma = rate.sigma / geodesy::wgs84.omega();
  if (!(sigma < 3.0 * units::deg)) return {};
  const double seen = std::atan2(rate.vertical, rate.horizontal), tolerance = std::max(2.0 * units::deg, 5.0 * sigma);
  if (std::abs(seen - place.latitude) <= tolerance) return {};
  const bool swapped = std::abs(seen - place.longitude) <= tolerance;
  return fail(
      {.file = file,
       .field = "latitude",
       .found = fmt::format("a latitude of {:.2f} deg where the gyroscopes of the standing vehicle see the Earth "
                            "turn as at {:.2f} deg, sigma {:.2f}",
                            place.latitude / units::deg, seen / units::deg, sigma / units::deg),
       .expected = "the same latitude from both",
       .advice = swapped ? "latitude and longitude look swapped: correct [columns]"
                         : "check latitude and longitude, the gyroscopes' unit and axes, and whether imu.grade "
                           "promises more than they hold"});
}

}  // namespace versine::inertial
