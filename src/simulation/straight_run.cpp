// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/straight_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "versine/geodesy/ellipsoid.hpp"
#include "versine/simulation/noise.hpp"

namespace versine::simulation {

namespace {

/// Bias of one axis as it varies: constant, instability, rate random walk. Renewed every `every` samples.
class VaryingBias {
 public:
  VaryingBias(const sensors::TriadErrors& e, bool flicker, double step, RandomStream& random)
      : constant_(e.bias * random.normal()),
        flicker_(flicker ? e.bias_instability : 0.0, step, 7200.0, random),
        markov_(flicker ? 0.0 : e.bias_instability, e.correlation_time, step, random),
        walk_(e.rate_random_walk, step) {}
  double next(RandomStream& random) {
    return constant_ + flicker_.next(random) + markov_.next(random) + walk_.next(random);
  }

 private:
  double constant_;
  FlickerNoise flicker_;
  GaussMarkov markov_;
  RandomWalk walk_;
};

/// Distance as a function of time: stand, go, stand, go.
struct Timetable {
  struct Piece {
    double start = 0.0, distance = 0.0, speed = 0.0;
  };
  std::vector<Piece> pieces;
  std::vector<std::pair<double, double>> stands;
  double end = 0.0;

  explicit Timetable(const StraightRun& run) {
    double t = 0.0, d = 0.0;
    const auto stand = [&](double seconds) {
      pieces.push_back({t, d, 0.0});
      stands.emplace_back(t, t + seconds);
      t += seconds;
    };
    stand(run.stand_first);
    for (const double length : run.spacing) {
      pieces.push_back({t, d, run.speed});
      t += length / run.speed;
      d += length;
      stand(run.stand);
    }
    end = t;
  }
  /// REQUIRES ascending times from call to call.
  double at(double t) {
    while (next_ + 1 < pieces.size() && pieces[next_ + 1].start <= t) ++next_;
    return pieces[next_].distance + pieces[next_].speed * (t - pieces[next_].start);
  }

 private:
  std::size_t next_ = 0;
};

}  // namespace

StraightRecording simulate_straight(const StraightRun& run, std::uint64_t seed) {
  RandomStream gyro(seed, "gyro"), accelerometer(seed, "accelerometer"), wheel(seed, "odometer"),
      total(seed, "landmark"), stray(seed, "path"), slip(seed, "slip");
  Timetable timetable(run);
  const auto n = static_cast<std::size_t>(timetable.end * run.rate);
  const double dt = 1.0 / run.rate;
  const std::int64_t step = std::llround(1e9 / run.rate);

  StraightRecording r;
  r.attitude = {0.0, 0.0, run.heading};
  r.imu.interval = {step};
  r.imu.samples.resize(n + 1);
  r.truth.resize(n + 1);
  r.distance.resize(n + 1);
  const Eigen::Matrix3d C_bn = geodesy::to_matrix(r.attitude).transpose();
  const double omega = geodesy::wgs84.omega(), slope = std::tan(run.latitude);
  const Eigen::Vector3d earth =
      C_bn * Eigen::Vector3d(omega * std::cos(run.latitude), 0.0, -omega * std::sin(run.latitude)) * dt;
  const double rn = 1.0 / (geodesy::wgs84.meridian_radius(run.latitude) + 100.0);
  const double re = 1.0 / (geodesy::wgs84.transverse_radius(run.latitude) + 100.0);
  const double c = std::cos(run.heading), s = std::sin(run.heading);
  const Eigen::Vector3d per_metre = C_bn * Eigen::Vector3d(s * re, -c * rn, -s * re * slope);
  const Eigen::Vector3d force = -(C_bn * geodesy::wgs84.gravity_ned(run.latitude, 100.0)) * dt;

  constexpr int hold = 10;  // samples for which a slow bias is held
  std::array<VaryingBias, 3> bias{VaryingBias(run.gyro, run.flicker, dt * hold, gyro),
                                  VaryingBias(run.gyro, run.flicker, dt * hold, gyro),
                                  VaryingBias(run.gyro, run.flicker, dt * hold, gyro)};
  Eigen::Vector3d bias_now = Eigen::Vector3d::Zero();
  const Eigen::Vector3d accelerometer_bias = run.accelerometer.bias * accelerometer.normal3() * dt;
  const double white = run.gyro.random_walk * std::sqrt(dt),
               white_force = run.accelerometer.random_walk * std::sqrt(dt);

  const int every = std::max(1, static_cast<int>(run.rate / run.odometer_rate));
  double scale = run.scale * wheel.normal(), wheel_distance = 0.0, wheel_before = 0.0, before = 0.0;
  geodesy::Geodetic place{run.latitude, 0.2, 100.0};
  const Eigen::Vector3d direction(c, s, 0.0);
  for (std::size_t i = 0; i <= n; ++i) {
    const Time time{static_cast<std::int64_t>(i) * step};
    const double d = timetable.at(time.seconds()), moved = i == 0 ? 0.0 : d - before;
    before = d;
    if (i % hold == 0) {
      for (int axis = 0; axis < 3; ++axis) bias_now[axis] = bias[std::size_t(axis)].next(gyro) * dt;
    }
    auto& sample = r.imu.samples[i];
    sample.time = time;
    sample.dtheta = earth + per_metre * moved + bias_now + white * gyro.normal3();
    sample.dvel = force + accelerometer_bias;
    if (white_force > 0.0) sample.dvel += white_force * accelerometer.normal3();
    r.distance[i] = d;
    if (moved != 0.0) {
      Eigen::Vector3d way = moved * direction;  // a rhumb line, metre by metre
      if (run.path_walk > 0.0) {
        const double step_walk = run.path_walk * std::sqrt(moved), aside = step_walk * stray.normal();
        way += Eigen::Vector3d(-s * aside, c * aside, step_walk * stray.normal());
      }
      place = geodesy::wgs84.displaced(place, way);
    }
    r.truth[i] = place;
    if (i % static_cast<std::size_t>(every) == 0 || i == n) {
      wheel_distance += (1.0 + scale) * (d - wheel_before);
      if (run.distance_walk > 0.0) wheel_distance += run.distance_walk * std::sqrt(d - wheel_before) * slip.normal();
      wheel_before = d;
      r.odometer.samples.push_back({time, wheel_distance});
      scale += run.scale_walk * std::sqrt(every * dt) * wheel.normal();
    }
  }
  for (std::size_t i = 0; i < timetable.stands.size(); ++i) {
    const auto [from, to] = timetable.stands[i];
    sensors::LandmarkSample l;
    l.from = Time::from_seconds(from + 0.05);
    l.to = Time::from_seconds(std::min(to - 0.05, timetable.end - 0.1));
    l.time = Time::from_seconds(0.5 * (l.from.seconds() + l.to.seconds()));
    l.name = "L" + std::to_string(i + 1);
    const auto at = static_cast<std::size_t>(l.time.seconds() * run.rate);
    l.position = geodesy::wgs84.displaced(r.truth[at], run.landmark * total.normal3());
    l.covariance = run.landmark * run.landmark * Eigen::Matrix3d::Identity();
    r.landmarks.samples.push_back(l);
  }
  return r;
}

}  // namespace versine::simulation
