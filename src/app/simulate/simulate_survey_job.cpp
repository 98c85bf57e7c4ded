// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "versine/app/simulate.hpp"
#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/simulation/irregularity.hpp"

namespace versine::app {

namespace {
std::string list(const Eigen::Vector3d& v) {
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x(), v.y(), v.z());
}

/// What a counter on a trolley's wheel is worth: its resolution, its slips, and 0.03 mm/sqrt(m) for uneven rails.
std::string wheel_noise(const simulation::OdometerModel& o) {
  const double resolution = std::max(o.quantum, 0.2e-3) / std::sqrt(12.0);
  const double slips = o.slip_distance * std::sqrt(2.0 * o.slip_per_km / 1000.0);
  return fmt::format(
      "sigma_m = {:.3g}\nrandom_walk_mpsqrtm = {:.3g}\nscale_sigma = {:.3g}\nscale_walk_psqrts = {:.3g}\n", resolution,
      std::hypot(3e-5, slips), std::max(2.0 * o.scale, 1e-4), std::max(o.scale_walk, 1e-6));
}

/// How far the middle of two wheels strays from the way that their line points, m sqrt(m): of the rail's irregularity y
/// it takes cos x - sin x / x, x = pi wheelbase / wavelength. As white noise of its density at 9 m: what shorter waves
/// add the IMU sees by itself, of longer ones the wheels take little.
double wander_of(const simulation::Scenario& s) {
  using simulation::Irregularity, simulation::spectral_density;
  constexpr double frequency = 1.0 / 9.0, least = 2e-6;
  const double x = std::numbers::pi * (s.trolley.front_x - s.trolley.rear_x) * frequency;
  const double share = std::cos(x) - std::sin(x) / x;
  const auto density = [&](Irregularity kind) { return spectral_density(s.track.spectrum, kind, frequency); };
  const double vertical = density(Irregularity::level) + 0.25 * density(Irregularity::cross_level);
  const double lateral = density(Irregularity::alignment) + 0.25 * density(Irregularity::gauge);
  return std::max(least, std::abs(share) * std::sqrt(0.5 * 0.5 * (vertical + lateral)));  // both axes; one-sided
}

/// Raw readings where there are some; positions of the same stations stand below them, to be put in their place.
std::string total_station_tables(const SimulateConfig& c, const simulation::SimulatedRecording& r,
                                 const Eigen::Matrix3d& C_bv) {
  const std::string lever = list(C_bv * c.total_station.place);
  const geodesy::Euler m = geodesy::to_euler(Eigen::Matrix3d(C_bv * geodesy::to_matrix(c.total_station.mounting)));
  const std::string positions = fmt::format("[landmarks]\nfile = \"landmarks.csv\"\nlever_arm_m = {}\n", lever);
  if (r.stationings.empty()) return r.landmarks.empty() ? "" : "\n" + positions;
  std::string text = fmt::format(
      "\n[total_station]\nreadings = [\"readings.csv\"]\ncontrol = [\"control.csv\"]\nlever_arm_m = {}\n"
      "mounting_deg = {}\nangle_sigma_arcsec = {:.4g}\ndistance_sigma_mm = {:.4g}\ndistance_sigma_ppm = {:.4g}\n",
      lever, list(Eigen::Vector3d(m.roll, m.pitch, m.yaw) / units::deg), c.total_station.sigma_angle / units::arcsec,
      c.total_station.sigma_distance / units::mm, c.total_station.sigma_distance_ppm / units::ppm);
  if (c.total_station.faces == 1) text += "one_face = true\n";
  if (!r.landmarks.empty()) {
    text += "\n# Positions that were computed elsewhere: put this table in place of [total_station].\n# ";
    for (const char ch : positions) text += ch == '\n' ? "\n# " : std::string(1, ch);
    text.resize(text.size() - 2);
  }
  return text;
}
}  // namespace

std::string survey_job_for(const SimulateConfig& c, const simulation::SimulatedRecording& r, bool with_design) {
  const auto& trolley = c.scenario.trolley;
  const geodesy::Euler& mounting = c.has_vehicle ? c.vehicle.mounting : trolley.mounting;
  // A job gives lever arms in the IMU's axes, a scenario in the trolley's.
  const Eigen::Matrix3d C_bv = geodesy::to_matrix(mounting).transpose();
  std::string text = fmt::format(
      "# Processes this simulated recording: versine survey survey.toml\njob = \"survey\"\n"
      "title = \"{}\"\n",
      c.title);
  if (!r.imu.empty()) {
    text += fmt::format("\n[imu]\nfile = \"imu.csv\"\ngrade = \"{}\"\nmounting_deg = {}\n", c.imu_errors.grade,
                        list(Eigen::Vector3d(mounting.roll, mounting.pitch, mounting.yaw) / units::deg));
    if (c.imu.instability == simulation::ImuModel::Instability::flicker) text += "instability = \"flicker\"\n";
  }
  if (!r.gnss.empty()) {
    text += fmt::format("\n[gnss]\nfile = \"gnss.csv\"\nlever_arm_m = {}\n", list(C_bv * c.gnss.antenna));
    // A receiver tells one sigma; that part of its errors stays alike for minutes is for the job to say.
    if (c.gnss.sigma_factor != 1.0) text += fmt::format("sigma_factor = {:.6g}\n", c.gnss.sigma_factor);
    if (c.gnss.correlated_horizontal > 0.0) {
      text += fmt::format("bias_sigma_m = {:.6g}\nbias_sigma_up_m = {:.6g}\nbias_time_s = {:.6g}\n",
                          c.gnss.correlated_horizontal, c.gnss.correlated_vertical, c.gnss.correlation_time);
    }
  }
  for (std::size_t i = 0; i < r.odometers.size(); ++i) {
    if (r.odometers[i].empty()) continue;
    text += fmt::format("\n[[odometer]]\nfile = \"odometer_{}.csv\"\n", i + 1);
  }
  if (!r.odometers.empty()) {
    const Eigen::Vector3d wheel = c.has_vehicle ? Eigen::Vector3d(-c.vehicle.imu)
                                                : Eigen::Vector3d(0.5 * (trolley.front_x + trolley.rear_x),
                                                                  trolley.reference_y, trolley.contact_z);
    text += fmt::format("\n[wheel]\nlever_arm_m = {}\n", list(C_bv * wheel));
    if (!c.has_vehicle) text += wheel_noise(c.scenario.equipment.odometers.front());
  }
  if (!c.has_vehicle) {
    // Rollers on rails: nothing but the rails' own irregularity moves a trolley sideways, and it comes back. The
    // simulated Earth has normal gravity.
    text += fmt::format(
        "\n[constraint]\nsigma_mps = 1e-6\nangle_rad = 5e-7\nwander_mm = {:.3g}\n\n[standstill]\nsigma_mps = "
        "0.00003\nposition_sigma_m = 1e-5\n\n[filter]\ngravity_walk_mgalpsqrtkm = 0\n",
        wander_of(c.scenario) / units::mm);
  }
  text += total_station_tables(c, r, C_bv);
  if (!c.has_vehicle && !r.imu.empty()) {
    const auto& track = c.scenario.track;
    text += fmt::format("\n[geometry]\ncrs = \"{}\"\n", track.alignment.crs);
    if (with_design) {
      const bool axis = track.cant_pivot == simulation::TrackModel::CantPivot::axis;
      text += fmt::format("design = \"design.xml\"\nheight_reference = \"{}\"\n", axis ? "axis" : "low-rail");
    }
    text += fmt::format(
        "[geometry.trolley]\nfront_x_m = {:.6g}\nrear_x_m = {:.6g}\nother_x_m = {:.6g}\nreference_y_m = {:.6g}\n"
        "contact_z_m = {:.6g}\nrange_x_m = {:.6g}\ngauge_offset_mm = {:.9g}\ngauge_temperature_mm_per_degC = {:.6g}\n",
        trolley.front_x, trolley.rear_x, trolley.other_x, trolley.reference_y, trolley.contact_z, trolley.range_x,
        trolley.gauge_offset / units::mm, trolley.gauge_temperature_factor / units::mm);
    // Simulated wheels are clean: what is left is what resampling at 0.25 m takes of the shortest waves, and the
    // gauge's noise in as many readings.
    const auto& legs = c.scenario.motion.legs;
    const double readings = legs.empty() ? 1.0 : std::max(1.0, 0.25 * c.gauge.rate / legs.front().speed);
    text += fmt::format("contact_sigma_mm = 0.006\ngauge_sigma_mm = {:.3g}\n",
                        std::hypot(c.gauge.noise / std::sqrt(readings), c.gauge.offset_error) / units::mm);
    if (!r.gauge.empty()) text += "[geometry.gauge]\nfile = \"gauge.csv\"\n";
    if (!r.sleeper.empty()) text += "[geometry.sleeper]\nfile = \"sleeper.csv\"\n";
  }
  return text;
}

}  // namespace versine::app
