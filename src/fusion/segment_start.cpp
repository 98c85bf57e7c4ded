// SPDX-License-Identifier: Apache-2.0
#include "segment_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "versine/core/units.hpp"
#include "versine/filter/kernels.hpp"
#include "versine/inertial/mechanization.hpp"

namespace versine::fusion::detail {

using Eigen::Vector3d;
using inertial::InitialAlignment;
using inertial::Interval;

std::vector<Segment> segments_of(const AidedInsInput& in, const AidedInsOptions& o) {
  std::vector<Segment> segments;
  const double longest = std::max(o.longest_imu_interval, 5.0 * in.imu.interval.seconds());
  std::size_t begin = 0;
  const auto close = [&](std::size_t end) {
    if (end > begin + 1) segments.push_back({begin, end, in.imu[begin].time - in.imu.interval, in.imu[end - 1].time});
    begin = end;
  };
  for (std::size_t i = 1; i < in.imu.size(); ++i) {
    const bool named = std::binary_search(in.segment_starts.begin(), in.segment_starts.end(), in.imu[i].time);
    if (named || (in.imu[i].time - in.imu[i - 1].time).seconds() > longest) close(i);
  }
  close(in.imu.size());
  return segments;
}

namespace {
struct Place {
  geodesy::Geodetic position;  ///< of the IMU
  double sigma = 0.0, age = 0.0;
};

/// The aid nearest to the start in time, less its lever arm. Its own sigma counts thirty times: it will be used again
/// as a measurement, and what it says must not count twice.
std::optional<Place> place_at(Time t, const AidedInsInput& in, const AidedInsOptions& o, const Eigen::Matrix3d& C_nb) {
  std::optional<Place> best;
  const auto offer = [&](Time at, const geodesy::Geodetic& g, double sigma, const Vector3d& lever) {
    const double age = std::abs((at - t).seconds());
    if (best && best->age <= age) return;
    best = Place{geodesy::wgs84.displaced(g, -(C_nb * lever)), 30.0 * sigma, age};
  };
  const auto nearest = [&](const auto& series, auto&& use) {
    const std::size_t i = series.lower_bound(t);
    if (i < series.size()) use(series[i]);
    if (i > 0) use(series[i - 1]);
  };
  if (o.use_gnss_position) {
    nearest(in.gnss, [&](const auto& s) {
      offer(s.time, s.position, s.sigma_ned.maxCoeff() * o.gnss_sigma_scale + o.gnss_bias, o.gnss_lever.l_b);
    });
  }
  nearest(in.landmarks, [&](const auto& s) {
    // It holds for the whole standstill, which may have begun minutes before its middle.
    const Time at = s.from < s.to ? std::clamp(t, s.from, s.to) : s.time;
    offer(at, s.position, std::sqrt(s.covariance.diagonal().maxCoeff()), o.landmark_lever.l_b);
  });
  if (best && best->age > 60.0) return std::nullopt;
  return best;
}

/// Velocity at the start, and its sigma: zero when standing, else odometer or speed along the heading, else GNSS. Not
/// GNSS first: what it shows of a vehicle that stands is noise, and an odometer's reading, linearised at a sideways
/// velocity that is not there, would tell the filter a heading that nobody has measured.
std::pair<Vector3d, double> velocity_at(Time t, const AidedInsInput& in, const Vector3d& forward_n,
                                        double heading_sigma, bool standing) {
  if (standing) return {Vector3d::Zero(), 0.02};
  const auto along = [&](double speed) {
    return std::pair<Vector3d, double>{forward_n * speed, std::hypot(0.3, std::abs(speed) * (0.03 + heading_sigma))};
  };
  const std::size_t d = in.odometer.lower_bound(t);
  if (d + 1 < in.odometer.size() && (in.odometer[d].time - t).seconds() < 3.0) {
    const std::size_t e =
        std::min(in.odometer.size() - 1, in.odometer.lower_bound(in.odometer[d].time + Duration::from_seconds(0.5)));
    const double dt = (in.odometer[e].time - in.odometer[d].time).seconds();
    if (dt > 0.0) return along((in.odometer[e].distance - in.odometer[d].distance) / dt);
  }
  const std::size_t s = in.speed.lower_bound(t);
  if (s < in.speed.size() && (in.speed[s].time - t).seconds() < 3.0) return along(in.speed[s].speed);
  const std::size_t g = in.gnss.lower_bound(t);
  if (g < in.gnss.size() && (in.gnss[g].time - t).seconds() < 3.0) {
    if (in.gnss[g].v_ned) return {*in.gnss[g].v_ned, 1.0};
    if (g + 1 < in.gnss.size()) {
      const double dt = (in.gnss[g + 1].time - in.gnss[g].time).seconds();
      return {geodesy::wgs84.ned_difference(in.gnss[g].position, in.gnss[g + 1].position) / dt,
              1.0 + 2.0 * in.gnss[g].sigma_ned.maxCoeff() / dt};
    }
  }
  return {Vector3d::Zero(), 10.0};
}

/// After a gap in motion: level as before it (a levelling in motion would take the vehicle's acceleration for a tilt),
/// heading from the course, or as before.
InitialAlignment in_motion_again(Time t, const AidedInsInput& in, const AidedInsOptions& o, const Previous& previous) {
  const double gap = std::min(5.0, (t - previous.estimate.nav.time).seconds());
  geodesy::Euler e = geodesy::to_euler(previous.estimate.nav.q_nb);
  InitialAlignment a{t, {}, {}, "previous segment"};
  double heading_sigma = 2.0 * units::deg + 0.1 * gap;
  inertial::CourseOptions options = o.course;
  options.vehicle_heading_in_b = -o.mounting.yaw;
  options.search = 60.0;
  const auto course = inertial::align_by_course(in.imu, t, in.gnss, o.imu_errors, options);
  if (course && course->sigma.z() < heading_sigma) {
    e.yaw = geodesy::to_euler(course->q_nb).yaw;
    a.method = "course";
    heading_sigma = std::max(course->sigma.z(), 2.0 * units::deg);
  }
  a.q_nb = geodesy::to_quaternion(e);
  const double tilt = 0.01 + 0.01 * gap;
  a.sigma = {tilt, tilt, heading_sigma};
  return a;
}

Expected<InitialAlignment> attitude_at(const Segment& segment, const AidedInsInput& in, const AidedInsOptions& o,
                                       const std::optional<Interval>& standing, const geodesy::Geodetic& position,
                                       const std::optional<Previous>& previous) {
  const Time t = segment.from;
  const Interval level = standing ? Interval{std::max(t, standing->from),
                                             std::min(standing->to, t + Duration::from_seconds(o.alignment_duration))}
                                  : Interval{t, t + Duration::from_seconds(1.0)};
  const auto with_heading = [&](double vehicle_heading, double sigma, const char* method) {
    auto a = inertial::level_with_heading(in.imu, level, geodesy::wrap_pi(vehicle_heading + o.mounting.yaw), sigma,
                                          o.imu_errors);
    if (a) {
      a->method = method;
      if (!standing) a->sigma.head<2>().array() += 0.02;  // the vehicle's own acceleration is in the level
    }
    return a;
  };
  if (previous && !standing) return in_motion_again(t, in, o, *previous);
  if (previous) {
    // It stopped while nobody looked: level anew, heading as it was, less sure by what a vehicle may have turned.
    const double gap = (t - previous->estimate.nav.time).seconds();
    const double yaw = geodesy::to_euler(previous->estimate.nav.q_nb).yaw - o.mounting.yaw;
    return with_heading(yaw, 2.0 * units::deg + 0.1 * std::min(gap, 5.0), "previous segment");
  }
  const bool automatic = o.heading_source == HeadingSource::automatic;
  if (automatic || o.heading_source == HeadingSource::gyrocompass) {
    if (standing) {
      auto a = inertial::gyrocompass(in.imu, level, position, o.imu_errors);
      const bool fine = a && a->sigma.z() < 5.0 * units::deg;
      if (fine || !automatic) return a;
    } else if (!automatic) {
      return fail({.field = "alignment",
                   .found = "a vehicle that moves at the start",
                   .expected = "a standstill for gyrocompassing",
                   .advice = "start the recording standing, or choose another heading source"});
    }
  }
  if (o.initial_heading && (automatic || o.heading_source == HeadingSource::given)) {
    return with_heading(*o.initial_heading, o.initial_heading_sigma, "given");
  }
  if (o.heading_source == HeadingSource::given) {
    return fail({.field = "alignment",
                 .found = "no initial heading",
                 .expected = "a heading in the job",
                 .advice = "give the initial heading, or choose another heading source"});
  }
  if (automatic && !in.heading.empty() && (in.heading.front().time - t).seconds() < 2.0) {
    return with_heading(in.heading.front().heading, 3.0 * in.heading.front().sigma, "given");
  }
  inertial::CourseOptions course = o.course;
  course.vehicle_heading_in_b = -o.mounting.yaw;
  return inertial::align_by_course(in.imu, t, in.gnss, o.imu_errors, course);
}

double bias_sigma(const sensors::TriadErrors& e) {
  return std::hypot(e.bias, e.bias_instability) + 1e-12;
}

Eigen::VectorXd initial_sigma(const AidedInsOptions& o, const InsLayout& l, const Start& s, double position,
                              double velocity) {
  Eigen::VectorXd sigma(l.size());
  const auto set = [&](auto block, double value) {
    if (block.enabled()) sigma.segment<decltype(block)::size>(block.offset).setConstant(value);
  };
  set(l.position, position);
  set(l.velocity, velocity);
  sigma.segment<3>(l.attitude.offset) = s.alignment.sigma;
  set(l.distance, o.odometer_sigma);
  // Where the wheels' way is counted from tells nothing.
  set(l.path, 10.0 * o.constraint_wander);
  set(l.gyro_bias, bias_sigma(o.imu_errors.gyro));
  set(l.accelerometer_bias, bias_sigma(o.imu_errors.accelerometer));
  set(l.gyro_scale, o.imu_errors.gyro.scale_factor + 1e-9);
  set(l.accelerometer_scale, o.imu_errors.accelerometer.scale_factor + 1e-9);
  set(l.odometer_scale, o.odometer_scale_sigma);
  set(l.mounting, o.mounting_sigma);
  set(l.gnss_lever, o.gnss_lever.sigma);
  set(l.wheel_lever, o.wheel_lever.sigma);
  if (l.gnss_bias.enabled()) sigma.segment<3>(l.gnss_bias.offset) = o.gnss_bias_sigma();
  set(l.landmark_position, 1.0);
  set(l.landmark_attitude, 1.0);
  return sigma;
}
/// A level taken from the accelerometers is off by their bias, and a heading taken from the gyros by theirs: the same
/// biases that are states. Taking the two for independent would make the filter believe that it knows half of each.
void correlate_level(const AidedInsOptions& o, const InsLayout& l, const Eigen::Matrix3d& C_nb,
                     const geodesy::Geodetic& position, Start& s) {
  const geodesy::LocalEarth earth = geodesy::wgs84.at(position.latitude, position.height);
  const double g = earth.gravity_ned.z();
  // phi_N = (C b)_E / g, phi_E = -(C b)_N / g, from C b + f x phi = 0 with f = (0, 0, -g).
  Eigen::Matrix3d from_force = Eigen::Matrix3d::Zero(), from_rate = Eigen::Matrix3d::Zero();
  from_force.row(0) = C_nb.row(1) / g;
  from_force.row(1) = -C_nb.row(0) / g;
  if (s.alignment.method == "gyrocompass") {
    // phi_D = ((C b_g)_E + omega_D phi_N) / omega_N, from the east component of omega_in x phi + C b_g = 0.
    const Vector3d omega = inertial::earth_rate(earth, geodesy::wgs84.omega());
    from_rate.row(2) = C_nb.row(1) / omega.x();
    from_force.row(2) = omega.z() / omega.x() * from_force.row(0);
  }
  const double force = std::pow(bias_sigma(o.imu_errors.accelerometer), 2);
  const double rate = std::pow(bias_sigma(o.imu_errors.gyro), 2);
  const Eigen::Matrix3d explained =
      force * from_force * from_force.transpose() + rate * from_rate * from_rate.transpose();
  const auto cross = [&s](int row, int column, const Eigen::Matrix3d& m) {
    s.covariance.block<3, 3>(row, column) = m;
    s.covariance.block<3, 3>(column, row) = m.transpose();
  };
  const Vector3d rest = (s.alignment.sigma.cwiseAbs2() - explained.diagonal()).cwiseMax(1e-10);
  s.covariance.block<3, 3>(l.attitude.offset, l.attitude.offset) = explained;
  s.covariance.block<3, 3>(l.attitude.offset, l.attitude.offset).diagonal() += rest;
  cross(l.attitude.offset, l.accelerometer_bias.offset, force * from_force);
  cross(l.attitude.offset, l.gyro_bias.offset, rate * from_rate);
}
}  // namespace

Expected<Start> start_of(const Segment& segment, const AidedInsInput& in, const AidedInsOptions& o,
                         const InsLayout& layout, const std::vector<Interval>& standstills,
                         const std::optional<Previous>& previous) {
  std::optional<Interval> standing;
  for (const Interval& s : standstills) {
    if ((s.from - segment.from).seconds() < 1.5 && s.to > segment.from) {
      standing = s;
      break;
    }
  }
  // A first position, lever arm aside, for the Earth rate; then the attitude; then the position with the lever arm.
  std::optional<Place> place = place_at(segment.from, in, o, Eigen::Matrix3d::Zero());
  if (!place && !o.initial_position && !previous) {
    return fail({.field = "position",
                 .found = "no position within 60 s of the start of the run",
                 .expected = "GNSS, a landmark or an initial position",
                 .advice = "give the initial position, or start the run where GNSS or a landmark begins"});
  }
  const bool given = !previous && o.initial_position && (!place || place->age > 5.0);
  Start s;
  s.standing = standing.has_value();
  if (previous) {
    s.estimate = previous->estimate;
  } else {
    s.estimate.C_vb = geodesy::to_matrix(o.mounting);
    s.estimate.gnss_lever = o.gnss_lever.l_b;
    s.estimate.wheel_lever = o.wheel_lever.l_b;
  }
  const geodesy::Geodetic rough = given   ? *o.initial_position
                                  : place ? place->position
                                          : previous->estimate.nav.position;
  Expected<InitialAlignment> alignment = attitude_at(segment, in, o, standing, rough, previous);
  if (!alignment) return fail(alignment.error());
  s.alignment = *alignment;
  inertial::NavState& nav = s.estimate.nav;
  nav.time = s.alignment.time = segment.from;
  nav.q_nb = s.alignment.q_nb;
  const Eigen::Matrix3d C_nb = nav.q_nb.toRotationMatrix();
  const Vector3d forward_n = C_nb * s.estimate.C_vb.row(0).transpose();
  const auto [velocity, velocity_sigma] = velocity_at(segment.from, in, forward_n, s.alignment.sigma.z(), s.standing);
  nav.v_eb_n = velocity;

  double position_sigma = o.initial_position_sigma;
  place = place_at(segment.from, in, o, C_nb);
  if (given) {
    nav.position = *o.initial_position;
  } else if (place) {
    nav.position = place->position;
    position_sigma = place->sigma + (s.standing ? 0.02 : velocity.norm() + velocity_sigma) * place->age;
  } else {
    const double gap = (segment.from - previous->estimate.nav.time).seconds();
    nav.position = geodesy::wgs84.displaced(previous->estimate.nav.position,
                                            0.5 * gap * (previous->estimate.nav.v_eb_n + velocity));
    position_sigma =
        std::sqrt(previous->covariance.diagonal().head<3>().maxCoeff()) + 0.3 * velocity.norm() * gap + 0.1 * gap * gap;
  }
  s.covariance = initial_sigma(o, layout, s, position_sigma, velocity_sigma).cwiseAbs2().asDiagonal();
  if (previous) {
    const auto n = layout.size() - layout.moving();
    s.covariance.bottomRightCorner(n, n) = previous->covariance.bottomRightCorner(n, n);
  } else {
    correlate_level(o, layout, C_nb, rough, s);
  }
  return s;
}

}  // namespace versine::fusion::detail
