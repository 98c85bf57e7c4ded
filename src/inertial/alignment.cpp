// SPDX-License-Identifier: Apache-2.0
#include "versine/inertial/alignment.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

#include "versine/core/units.hpp"
#include "versine/inertial/mechanization.hpp"

namespace versine::inertial {

using Eigen::Vector3d;

namespace {
struct Mean {
  Vector3d rate = Vector3d::Zero(), force = Vector3d::Zero();
  double seconds = 0.0;
};

Mean mean(const sensors::ImuSeries& imu, const Interval& span) {
  Mean m;
  const auto samples = imu.between({span.from.ns + 1}, {span.to.ns + 1});
  for (const auto& s : samples) {
    m.rate += s.dtheta;
    m.force += s.dvel;
  }
  m.seconds = static_cast<double>(samples.size()) * imu.interval.seconds();
  m.rate /= m.seconds;
  m.force /= m.seconds;
  return m;
}

geodesy::Euler levelled(const Vector3d& force, double yaw) {
  return {std::atan2(-force.y(), -force.z()), std::atan2(force.x(), std::hypot(force.y(), force.z())), yaw};
}

double total_bias(const sensors::TriadErrors& e) {
  return std::hypot(e.bias, e.bias_instability);
}

Expected<Mean> levelling_mean(const sensors::ImuSeries& imu, const Interval& span) {
  const Mean m = mean(imu, span);
  if (!(m.seconds > 0.0)) {
    return fail({.field = "alignment",
                 .found = "no IMU samples at the start",
                 .expected = "an IMU that runs",
                 .advice = "check the clocks: does the IMU's recording cover the time of the run?"});
  }
  if (!(std::abs(m.force.norm() - 9.81) < 0.5) || !(m.force.z() < 0.0)) {
    return fail({.field = "alignment",
                 .found = fmt::format("a mean specific force of ({:.2f}, {:.2f}, {:.2f}) m/s^2", m.force.x(),
                                      m.force.y(), m.force.z()),
                 .expected = "about (0, 0, -9.8) with axes forward, right, down",
                 .advice = "check the unit of the accelerometers and the declared axes"});
  }
  return m;
}
}  // namespace

namespace {
/// Mean specific force over one window, in the b-frame of the start and, as gravity says it must be, in the n-frame of
/// the start; neither frame turns in inertial space.
struct ForcePair {
  Vector3d measured, expected;
};

std::vector<ForcePair> force_pairs(const sensors::ImuSeries& imu, const Interval& standing,
                                   const geodesy::Geodetic& position, double window,
                                   const geodesy::Ellipsoid& ellipsoid) {
  const geodesy::LocalEarth earth = ellipsoid.at(position.latitude, position.height);
  const Vector3d omega = earth_rate(earth, ellipsoid.omega());
  std::vector<ForcePair> pairs;
  Eigen::Quaterniond q_start_b = Eigen::Quaterniond::Identity();
  Vector3d sum = Vector3d::Zero();
  double seconds = 0.0, middle = 0.0;
  for (const auto& s : imu.between({standing.from.ns + 1}, {standing.to.ns + 1})) {
    const Eigen::Quaterniond half = geodesy::from_rotation_vector(0.5 * s.dtheta);
    sum += (q_start_b * half) * s.dvel;
    q_start_b = q_start_b * half * half;
    seconds += imu.interval.seconds();
    if (seconds + 1e-9 < window) continue;
    middle += 0.5 * seconds;
    pairs.push_back({sum / seconds, geodesy::from_rotation_vector(omega * middle) * -earth.gravity_ned});
    middle += 0.5 * seconds;
    sum.setZero();
    seconds = 0.0;
  }
  return pairs;
}

/// The rotation that takes the measured forces to the expected ones with least squares (Kabsch 1976).
Eigen::Matrix3d best_rotation(const std::vector<ForcePair>& pairs) {
  Eigen::Matrix3d b = Eigen::Matrix3d::Zero();
  for (const ForcePair& p : pairs) b += p.expected * p.measured.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(b, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixU() * Vector3d(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
}

/// Sigma of the slope of the level residuals, rad/s: what rocking, vibration and accelerometer noise leave in the drift
/// of the vertical. Neighbouring residuals that are alike carry less: the lag-one correlation widens it.
double drift_sigma(const std::vector<ForcePair>& pairs, const Eigen::Matrix3d& rotation, double window) {
  double square = 0.0, product = 0.0;
  Eigen::Vector2d before = Eigen::Vector2d::Zero();
  for (const ForcePair& p : pairs) {
    const Eigen::Vector2d r = (rotation * p.measured - p.expected).head<2>() / p.expected.norm();
    square += r.squaredNorm();
    product += r.dot(before);
    before = r;
  }
  const auto n = static_cast<double>(pairs.size());
  const double correlation = std::clamp(square > 0.0 ? product / square : 0.0, 0.0, 0.95);
  const double variance = square / std::max(1.0, 2.0 * n - 3.0) * (1.0 + correlation) / (1.0 - correlation);
  return std::sqrt(12.0 * variance / (n * (n * n - 1.0))) / window;
}
}  // namespace

Expected<InitialAlignment> gyrocompass(const sensors::ImuSeries& imu, const Interval& standing,
                                       const geodesy::Geodetic& position, const sensors::ImuErrors& errors,
                                       const geodesy::Ellipsoid& ellipsoid) {
  const Expected<Mean> m = levelling_mean(imu, standing);
  if (!m) return fail(m.error());
  const double window = std::clamp(m->seconds / 12.0, 2.0 * imu.interval.seconds(), 10.0);
  const std::vector<ForcePair> pairs = force_pairs(imu, standing, position, window, ellipsoid);
  const double horizontal = ellipsoid.omega() * std::cos(position.latitude);
  const double gyro = std::hypot(total_bias(errors.gyro), errors.gyro.random_walk / std::sqrt(m->seconds));
  const double tilt = std::hypot(total_bias(errors.accelerometer) / 9.78, 2e-5);
  const Eigen::Matrix3d C_nb = best_rotation(pairs);
  const double drift = pairs.size() > 3 ? drift_sigma(pairs, C_nb, window) : horizontal;
  const double heading_sigma =
      std::hypot(std::hypot(gyro, drift) / horizontal, tilt * std::abs(std::tan(position.latitude)));
  if (!(heading_sigma < 30.0 * units::deg)) {
    return fail({.field = "alignment",
                 .found = fmt::format("gyros with a rate error of {:.1f} deg/h after {:.0f} s, and a vertical known to "
                                      "{:.1f} deg/h",
                                      gyro / units::deg_per_hour, m->seconds, drift / units::deg_per_hour),
                 .expected = "an instrument and a standstill that resolve the Earth's rotation (heading sigma below 30 "
                             "degrees)",
                 .advice = "stand still longer, give an initial heading, or take it from the GNSS course"});
  }
  return InitialAlignment{standing.from, Eigen::Quaterniond(C_nb), {tilt, tilt, heading_sigma}, "gyrocompass"};
}

Expected<InitialAlignment> level_with_heading(const sensors::ImuSeries& imu, const Interval& span, double heading,
                                              double heading_sigma, const sensors::ImuErrors& errors,
                                              const Vector3d& acceleration_b) {
  Expected<Mean> m = levelling_mean(imu, span);
  if (!m) return fail(m.error());
  m->force -= acceleration_b;
  const double tilt = std::hypot(total_bias(errors.accelerometer) / 9.78, 1e-4);
  return InitialAlignment{
      span.to, geodesy::to_quaternion(levelled(m->force, heading)), {tilt, tilt, heading_sigma}, "given"};
}

namespace {
/// Course of a GNSS epoch, with its sigma: from its velocity, else from the way since the epoch before.
struct Course {
  double angle = 0.0, sigma = 0.0;
};
std::optional<Course> course_at(const Series<sensors::GnssSample>& gnss, std::size_t i, double minimum_speed,
                                const geodesy::Ellipsoid& ellipsoid) {
  const auto of = [](const Vector3d& v, double sigma) {
    return Course{std::atan2(v.y(), v.x()), sigma / std::hypot(v.x(), v.y())};
  };
  if (gnss[i].v_ned) {
    if (!(std::hypot(gnss[i].v_ned->x(), gnss[i].v_ned->y()) >= minimum_speed)) return std::nullopt;
    return of(*gnss[i].v_ned, std::max(0.02, gnss[i].sigma_v_ned.head<2>().norm()));
  }
  if (i == 0 || i + 1 >= gnss.size()) return std::nullopt;
  const Vector3d way = ellipsoid.ned_difference(gnss[i - 1].position, gnss[i + 1].position);
  const double dt = (gnss[i + 1].time - gnss[i - 1].time).seconds(), length = std::hypot(way.x(), way.y());
  if (!(dt < 5.0) || !(length >= minimum_speed * dt) || !(length > 5.0 * gnss[i].sigma_ned.head<2>().norm())) {
    return std::nullopt;
  }
  return of(way, 1.4 * gnss[i].sigma_ned.head<2>().norm());
}
}  // namespace

Expected<InitialAlignment> align_by_course(const sensors::ImuSeries& imu, Time start,
                                           const Series<sensors::GnssSample>& gnss, const sensors::ImuErrors& errors,
                                           const CourseOptions& options, const geodesy::Ellipsoid& ellipsoid) {
  const Interval first{start, start + Duration::from_seconds(1.0)};
  Expected<InitialAlignment> level = level_with_heading(imu, first, 0.0, 1.0, errors);
  if (!level) return level;

  // Attitude alone, from the levelled start; its heading is relative to the unknown one at the start.
  Eigen::Quaterniond q = level->q_nb;
  std::size_t g = gnss.lower_bound(start);
  const geodesy::Geodetic place = gnss.empty() ? geodesy::Geodetic{} : gnss[std::min(g, gnss.size() - 1)].position;
  const Eigen::Quaterniond earth_turn = geodesy::from_rotation_vector(
      -imu.interval.seconds() * earth_rate(ellipsoid.at(place.latitude, place.height), ellipsoid.omega()));
  double sine = 0.0, cosine = 0.0, weight = 0.0, used_from = -1.0;
  std::size_t count = 0;
  for (std::size_t i = imu.lower_bound({start.ns + 1}); i < imu.size() && g < gnss.size(); ++i) {
    const double since = (imu[i].time - start).seconds();
    if (since > options.search || (used_from >= 0.0 && since - used_from > options.use)) break;
    q = earth_turn * (q * geodesy::from_rotation_vector(imu[i].dtheta));
    while (g < gnss.size() && gnss[g].time <= imu[i].time) {
      if (const auto course = course_at(gnss, g, options.minimum_speed, ellipsoid)) {
        const double carried = geodesy::to_euler(q).yaw - options.vehicle_heading_in_b;
        const double start_heading = course->angle - carried, w = 1.0 / (course->sigma * course->sigma + 1e-4);
        sine += w * std::sin(start_heading);
        cosine += w * std::cos(start_heading);
        weight += w;
        ++count;
        if (used_from < 0.0) used_from = since;
      }
      ++g;
    }
  }
  if (count == 0) {
    return fail({.field = "alignment",
                 .found = fmt::format("no GNSS course above {:.1f} m/s within {:.0f} s of the start",
                                      options.minimum_speed, options.search),
                 .expected = "a stretch driven forward with GNSS",
                 .advice = "give an initial heading, or start the run where the vehicle moves"});
  }
  // Circular spread of the differences: what side slip, noise and gyro drift together make of it.
  const double concentration = std::min(1.0, std::hypot(sine, cosine) / weight);
  const double spread = std::sqrt(std::max(0.0, -2.0 * std::log(concentration)));
  const double drift = total_bias(errors.gyro) * (used_from + options.use);
  const double sigma = std::sqrt(spread * spread + drift * drift + std::pow(1.0 * units::deg, 2));
  geodesy::Euler e = geodesy::to_euler(level->q_nb);
  e.yaw = std::atan2(sine, cosine);
  // A start in motion is levelled with the vehicle's own acceleration in it: some tenths of m/s^2.
  const double tilt = std::hypot(level->sigma.x(), 0.05);
  return InitialAlignment{start, geodesy::to_quaternion(e), {tilt, tilt, sigma}, "course"};
}

}  // namespace versine::inertial
