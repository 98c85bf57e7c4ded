// SPDX-License-Identifier: Apache-2.0
#include "tunnel.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "versine/core/units.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::study {

using namespace units;

namespace {
constexpr double inf = std::numeric_limits<double>::infinity();

auto tunnel_motion(double spacing) {
  decltype(simulation::Scenario::motion) m;
  m.start = 20.0;
  m.stand = 900.0;
  m.legs.push_back({.to = 5120.0, .speed = 1.0, .stop = 30.0, .stop_every = spacing, .stop_each = 30.0});
  return m;
}

}  // namespace

simulation::Scenario tunnel_line(double radius, double cant, double spacing) {
  simulation::Scenario s = jiang_trolley(30 * deg);
  if (!std::isfinite(radius)) {
    s.track.alignment.horizontal =
        *design::HorizontalAxis::chain({500000.0, 5250000.0, 30 * deg}, {design::line(5200.0)});
    s.track.spectrum = simulation::Spectrum::german_low;
    s.motion = tunnel_motion(spacing);
    s.equipment.total_station->every = spacing;
    return s;
  }
  const auto turn = [&](double sign) {
    return std::array{design::transition(design::Shape::clothoid, 100.0, inf, sign * radius),
                      design::arc(700.0, sign * radius),
                      design::transition(design::Shape::clothoid, 100.0, sign * radius, inf)};
  };
  std::vector<design::HorizontalElement> e{design::line(700.0)};
  design::CantProfile profile;
  std::vector<design::CantPoint> cants;
  double at = 700.0;
  for (const double sign : {1.0, -1.0, 1.0}) {
    for (const auto& element : turn(sign)) e.push_back(element);
    cants.push_back({.distance = at, .cant = 0.0});
    cants.push_back({.distance = at + 100.0, .cant = sign * cant});
    cants.push_back({.distance = at + 800.0, .cant = sign * cant});
    cants.push_back({.distance = at + 900.0, .cant = 0.0});
    e.push_back(design::line(600.0));
    at += 1500.0;
  }
  s.track.alignment.horizontal = *design::HorizontalAxis::chain({500000.0, 5250000.0, 30 * deg}, e);
  s.track.alignment.cant = *design::CantProfile::from_points(cants);
  s.track.spectrum = simulation::Spectrum::german_low;
  s.motion = tunnel_motion(spacing);
  s.equipment.total_station->every = spacing;
  return s;
}

void TunnelErrors::print(const char* name) const {
  const std::pair<const char*, const Squares*> rows[] = {{"straight", &straight}, {"ramps", &ramp}, {"curves", &curve}};
  for (const auto& [part, s] : rows) {
    const auto rms = s->rms();
    const auto share = s->inside / s->count;
    fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.0f} / {:.0f} / {:.0f} |\n", name, part, rms[0] / mm,
               rms[1] / mm, rms[2] / mm, 100 * share[0], 100 * share[1], 100 * share[2]);
  }
}

TunnelErrors judge(const geodesy::Trajectory& t, const simulation::SimulatedRecording& r,
                   const simulation::Scenario& s) {
  TunnelErrors errors;
  double last = -1.0;
  for (std::size_t i = 0; i < r.truth.progress.size(); ++i) {
    const double d = r.truth.progress[i].distance;
    if (d < last + 2.0) continue;
    last = d;
    Eigen::Vector3d e;
    Eigen::Matrix3d P;
    if (!error_at(t, r.truth.trajectory[i], e, P)) continue;
    const double yaw = geodesy::to_euler(r.truth.trajectory[i].q_nb).yaw;
    Eigen::Matrix3d R;  // lateral, vertical, longitudinal
    R << -std::sin(yaw), std::cos(yaw), 0, 0, 0, 1, std::cos(yaw), std::sin(yaw), 0;
    const auto pose = s.track.alignment.horizontal.at(d);
    Squares& part = pose.curvature_rate != 0.0 ? errors.ramp : pose.curvature != 0.0 ? errors.curve : errors.straight;
    part.add(R * e, R * P * R.transpose());
  }
  return errors;
}

Expected<Solved> solve(simulation::Scenario s, std::uint64_t seed, double mounting) {
  s.trolley.mounting = {mounting, -mounting, mounting};
  auto r = simulation::simulate(s, seed);
  if (!r) return tl::unexpected(r.error());
  Series<sensors::LandmarkSample> landmarks;
  landmarks.samples = r->landmarks;
  SilentProgress silent;
  SilentLog log;
  auto o = options_for(s);
  o.mounting_sigma = std::max(mounting, 0.02e-3);
  auto reckoned = fusion::run_landmark_dead_reckoning({&r->imu, &r->odometers[0], &landmarks}, o, silent);
  if (!reckoned) return tl::unexpected(reckoned.error());
  Solved result{.recording = std::move(*r), .reckoned = std::move(*reckoned)};

  fusion::AidedInsOptions a;
  a.imu_errors = s.equipment.imu->errors;
  a.mounting_sigma = std::max(mounting, 0.02e-3);
  a.wheel_lever.l_b = o.lever_odometer;
  a.landmark_lever.l_b = o.lever_landmark;
  // Rollers on rails: what is left of the irregularity over metres, as in the job of a simulated recording.
  const double rough = s.track.spectrum_factor < 0.01 ? 1.0 : 10.0;
  a.constraint_sigma = 2e-5 * rough;
  a.constraint_angle = 1e-5 * rough;
  a.constraint_peak = 2e-4 * rough;
  a.zero_velocity_sigma = 3e-5;
  a.odometer_sigma = 0.1 * mm;
  a.odometer_random_walk = 0.05 * mm;
  a.odometer_scale_sigma = 1e-3;
  a.odometer_scale_walk = 8e-6;
  a.alignment_duration = 900.0;
  const fusion::AidedInsInput in{
      .imu = result.recording.imu, .odometer = result.recording.odometers[0], .landmarks = landmarks};
  auto aided = fusion::run_aided_ins(in, a, silent, log);
  if (!aided) return tl::unexpected(aided.error());
  result.aided = std::move(*aided);
  return result;
}

Eigen::Array3d difference(const geodesy::Trajectory& a, const geodesy::Trajectory& b) {
  Squares all;
  for (std::size_t i = 0; i < b.size(); i += 20) {
    Eigen::Vector3d e;
    Eigen::Matrix3d P;
    if (!error_at(a, b[i], e, P)) continue;
    const double yaw = geodesy::to_euler(b[i].q_nb).yaw;
    all.add({-std::sin(yaw) * e.x() + std::cos(yaw) * e.y(), e.z(), std::cos(yaw) * e.x() + std::sin(yaw) * e.y()}, P);
  }
  return all.rms();
}

double largest_model_error(const fusion::LandmarkSolution& s) {
  double worst = 0.0;
  for (const auto& stretch : s.stretches) worst = std::max(worst, stretch.model_error);
  return worst;
}

}  // namespace versine::study
