// SPDX-License-Identifier: Apache-2.0
#include "versine/fusion/landmark_alignment.hpp"

#include <fmt/format.h>

#include <cmath>

#include "versine/fusion/planning.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::fusion::landmark {

namespace {

constexpr double shortest_standstill = 30.0;  // s; below, white noise alone costs a navigation gyro a degree of heading

/// When the odometer first leaves its first value by more than the tolerance.
Time first_motion(const Series<sensors::OdometerSample>& odometer, double tolerance) {
  for (const auto& o : odometer) {
    if (std::abs(o.distance - odometer.front().distance) > tolerance) return o.time;
  }
  return odometer.back().time;
}

Eigen::Vector3d earth_rate_n(double latitude) {
  return geodesy::wgs84.omega() * Eigen::Vector3d(std::cos(latitude), 0.0, -std::sin(latitude));
}

/// Sigma of the equivalent bias left after the mean rate of `duration` seconds was taken off.
double remaining_bias(const LandmarkOptions& o, double duration) {
  if (o.bias_sigma) return *o.bias_sigma;
  return std::hypot(o.gyro.random_walk / std::sqrt(duration), o.gyro.bias_instability,
                    o.gyro.rate_random_walk * std::sqrt(duration));
}

StaticStart from_given(const GivenAttitude& given, const geodesy::Geodetic& place, const LandmarkOptions& o) {
  StaticStart start;
  start.q_nb = geodesy::to_quaternion(given.attitude) * geodesy::to_quaternion(o.mounting);
  start.pitch_sigma = given.level_sigma;
  start.roll_sigma = given.level_sigma;
  start.heading_sigma = given.heading_sigma;
  start.bias_sigma =
      o.bias_sigma.value_or(equivalent_bias(std::hypot(o.gyro.bias, o.gyro.bias_instability), given.level_sigma,
                                            given.heading_sigma, place.latitude, given.attitude.yaw)
                                .lateral);
  return start;
}

}  // namespace

Expected<StaticStart> static_start(const sensors::ImuSeries& imu, const Series<sensors::OdometerSample>& odometer,
                                   const geodesy::Geodetic& place, const LandmarkOptions& options) {
  if (options.attitude) return from_given(*options.attitude, place, options);
  const Time moved = first_motion(odometer, options.standing_tolerance + options.odometer_resolution);
  const Time last = std::min(moved - Duration::from_seconds(1.0),
                             imu.front().time + Duration::from_seconds(options.alignment_duration));
  const double duration = (last - imu.front().time).seconds();
  if (!(duration >= shortest_standstill)) {
    return fail(
        {.field = "static alignment",
         .found = fmt::format("{:.0f} s from the first IMU sample until the odometer moves",
                              std::max(0.0, (moved - imu.front().time).seconds())),
         .expected = fmt::format("a standing start of at least {:.0f} s, better 15 minutes", shortest_standstill),
         .advice = "let the trolley stand at the start, or give the attitude in the job "
                   "(initial attitude with its sigma)"});
  }
  Eigen::Vector3d dtheta = Eigen::Vector3d::Zero(), dvel = Eigen::Vector3d::Zero();
  std::size_t n = 1;
  for (; n < imu.size() && imu[n].time <= last; ++n) {
    dtheta += imu[n].dtheta;
    dvel += imu[n].dvel;
  }
  StaticStart start;
  start.sample = n - 1;
  start.duration = (imu[n - 1].time - imu.front().time).seconds();
  const Eigen::Vector3d rate = dtheta / start.duration, force = dvel / start.duration;
  const double g = geodesy::wgs84.gravity_ned(place.latitude, place.height).norm();
  if (!(std::abs(force.norm() - g) < 0.01 * g)) {
    return fail({.field = "static alignment",
                 .found = fmt::format("a mean specific force of {:.4g} m/s^2 while standing", force.norm()),
                 .expected = fmt::format("gravity, {:.4f} m/s^2", g),
                 .advice = "check the IMU's units and that dvel is there; without accelerometers give the attitude"});
  }
  const Eigen::Vector3d up = -force.normalized();  // down, in b
  geodesy::Euler e{std::atan2(up.y(), up.z()), std::atan2(-up.x(), std::hypot(up.y(), up.z())), 0.0};
  const Eigen::Vector3d level_rate = geodesy::to_matrix(e) * rate;
  const double noise = options.gyro.random_walk / std::sqrt(start.duration);
  if (options.heading) {
    // The heading is the trolley's: take the mounting's share of the yaw off.
    e.yaw = *options.heading + options.mounting.yaw;
    start.heading_sigma = options.heading_sigma;
  } else {
    e.yaw = std::atan2(-level_rate.y(), level_rate.x());
    start.heading_sigma = std::hypot(
        gyrocompass_heading_error(std::hypot(options.gyro.bias, options.gyro.bias_instability, noise), place.latitude),
        1e-5);
    if (!(start.heading_sigma < 10.0 * units::deg)) {
      return fail({.field = "static alignment",
                   .found = fmt::format("gyros that find north to {:.0f} deg only", start.heading_sigma / units::deg),
                   .expected = "10 deg or better",
                   .advice = "give the heading of the track at the start, with its sigma"});
    }
  }
  start.q_nb = geodesy::to_quaternion(e);
  start.mean_rate = rate;
  start.latitude = place.latitude;
  start.rate_bias = rate - start.q_nb.conjugate() * earth_rate_n(place.latitude);
  start.pitch_sigma = options.pitch_sigma;
  start.roll_sigma = options.levelling_sigma;
  start.bias_sigma = remaining_bias(options, start.duration);
  return start;
}

StaticStart with_heading(StaticStart start, double heading, double sigma) {
  start.q_nb = Eigen::Quaterniond(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ())) * start.q_nb;
  start.heading_sigma = sigma;
  if (start.duration > 0.0) start.rate_bias = start.mean_rate - start.q_nb.conjugate() * earth_rate_n(start.latitude);
  return start;
}

}  // namespace versine::fusion::landmark
