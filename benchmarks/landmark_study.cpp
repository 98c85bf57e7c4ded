// SPDX-License-Identifier: Apache-2.0
// Landmark dead reckoning on simulated recordings with known truth; prints the tables of docs/planning.md.
//   versine_landmark_study groups SEEDS     six runs of 120 m as in Jiang 2017 section 6.2
//   versine_landmark_study tunnel [SEED]    5 km with curves and cant, beside the aided INS
//   versine_landmark_study validity         the same line tighter and tighter: the reduced model's own error
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "versine/core/units.hpp"
#include "versine/fusion/aided_ins.hpp"
#include "versine/fusion/landmark_dead_reckoning.hpp"
#include "versine/geodesy/ellipsoid.hpp"
#include "versine/simulation/random.hpp"
#include "versine/simulation/simulate.hpp"
#include "versine/simulation/world.hpp"

namespace {

using namespace versine;
using namespace versine::units;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr const char* crs = "+proj=tmerc +lat_0=0 +lon_0=9 +k=1 +x_0=500000 +ellps=GRS80 +units=m";

simulation::Scenario base(double heading) {
  simulation::Scenario s;
  s.track.alignment.crs = crs;
  s.track.height = 400.0;
  simulation::ImuModel imu;
  imu.errors = sensors::find_imu_grade("rlg-jiang")->errors;
  s.equipment.imu = imu;
  simulation::OdometerModel odometer;
  odometer.output = simulation::OdometerModel::Output::distance;
  odometer.rate = 50.0;
  odometer.quantum = 0.1 * mm;
  odometer.scale = 1e-3;
  odometer.scale_walk = 8e-6;
  s.equipment.odometers.push_back(odometer);
  simulation::TotalStationModel station;
  station.every = 60.0;
  s.equipment.total_station = station;
  s.track.alignment.horizontal = *design::HorizontalAxis::chain({500000.0, 5250000.0, heading}, {design::line(400.0)});
  return s;
}

fusion::LandmarkOptions options_for(const simulation::Scenario& s) {
  fusion::LandmarkOptions o;
  o.gyro = s.equipment.imu->errors.gyro;
  o.levelling_sigma = s.equipment.imu->errors.accelerometer.bias / 9.81;
  o.lever_odometer = {0.5 * (s.trolley.front_x + s.trolley.rear_x), s.trolley.reference_y, s.trolley.contact_z};
  o.lever_landmark = s.equipment.total_station->place;
  o.scale_sigma = s.equipment.odometers[0].scale;
  o.odometer_resolution = s.equipment.odometers[0].quantum;
  o.path_walk = 0.01 * mm;
  o.standing_tolerance = 3 * mm;
  return o;
}

/// Sum of squares in three directions.
struct Squares {
  Eigen::Array3d sum = Eigen::Array3d::Zero(), normalised = Eigen::Array3d::Zero(), inside = Eigen::Array3d::Zero();
  double count = 0.0;
  void add(const Eigen::Vector3d& e, const Eigen::Matrix3d& P) {
    sum += e.array().square();
    normalised += e.array().square() / P.diagonal().array();
    inside += (e.array().abs() < 1.96 * P.diagonal().array().sqrt()).cast<double>();
    ++count;
  }
  [[nodiscard]] Eigen::Array3d rms() const { return (sum / count).sqrt(); }
};

/// Error of a trajectory against the truth at a true point, north-east-down.
bool error_at(const geodesy::Trajectory& t, const geodesy::TrajectoryPoint& truth, Eigen::Vector3d& e,
              Eigen::Matrix3d& P) {
  const std::size_t i = t.lower_bound(truth.time);
  if (i == 0 || i >= t.size()) return false;
  const auto &a = t[i - 1], &b = t[i];
  const double u = (truth.time - a.time).seconds() / (b.time - a.time).seconds();
  e = (1 - u) * geodesy::wgs84.ned_difference(truth.position, a.position) +
      u * geodesy::wgs84.ned_difference(truth.position, b.position);
  P = a.position_covariance.matrix();
  return true;
}

// --- Jiang section 6.2
// ------------------------------------------------------------------------------------------------

/// One power cycle: 15 minutes of standing, then three times 120 m with landmarks at 0, 60 and 120 m, driven back
/// between them.
simulation::Scenario power_cycle() {
  simulation::Scenario s = base(90 * deg);  // east: the lateral direction is north, as in the paper's table
  s.track.spectrum = simulation::Spectrum::german_low;
  s.motion.start = 20.0;
  s.motion.stand = 900.0;
  for (int group = 0; group < 3; ++group) {
    s.motion.legs.push_back({.to = 140.0, .speed = 1.0, .stop = 30.0, .stop_every = 60.0, .stop_each = 30.0});
    if (group < 2) s.motion.legs.push_back({.to = 20.0, .speed = 1.0, .stop = 30.0});
  }
  return s;
}

int groups(int seeds) {
  constexpr double calibrated = 0.05e-3;  // rad, what calibration left of each mounting angle
  simulation::Scenario scenario = power_cycle();
  std::vector<std::array<Squares, 6>> all;
  SilentProgress silent;
  for (int seed = 0; seed < seeds; ++seed) {
    std::array<Squares, 6> result;
    simulation::RandomStream mounting(simulation::run_seed(7, std::uint64_t(seed)), "mounting");
    scenario.trolley.mounting = {calibrated * mounting.normal(), calibrated * mounting.normal(),
                                 calibrated * mounting.normal()};
    const auto world = simulation::prepare(scenario);
    if (!world) return fmt::print(stderr, "{}\n", world.error().message()), 1;
    auto options = options_for(scenario);
    options.mounting_sigma = calibrated;
    for (int cycle = 0; cycle < 2; ++cycle) {
      const auto r = simulation::observe(**world, simulation::run_seed(7, std::uint64_t(2 * seed + cycle)));
      Series<sensors::LandmarkSample> landmarks;
      landmarks.samples = r.landmarks;
      const auto solved = fusion::run_landmark_dead_reckoning({&r.imu, &r.odometers[0], &landmarks}, options, silent);
      if (!solved) return fmt::print(stderr, "{}\n", solved.error().message()), 1;
      // Every 3 m of each way out.
      std::size_t group = 3 * std::size_t(cycle);
      bool out = false;
      double next = 20.0;
      for (std::size_t i = 0; i < r.truth.progress.size(); ++i) {
        const auto& p = r.truth.progress[i];
        if (p.speed < 0.0 && out) {
          out = false;
          next = 20.0;
          ++group;
        }
        if (!(p.speed > 0.0) || p.distance < next) continue;
        out = true;
        next += 3.0;
        Eigen::Vector3d e;
        Eigen::Matrix3d P;
        if (error_at(solved->solution.smoothed, r.truth.trajectory[i], e, P)) result[group].add(e, P);
      }
    }
    all.push_back(result);
  }
  const auto table = [&](const char* title, const auto& value) {
    fmt::print(
        "\n{}\n\n| RMS, mm | group 1 | group 2 | group 3 | group 4 | group 5 | group 6 "
        "|\n|---|---|---|---|---|---|---|\n",
        title);
    const std::pair<const char*, int> rows[] = {{"north", 0}, {"vertical", 2}, {"east", 1}};
    for (const auto& [name, axis] : rows) {
      fmt::print("| {} |", name);
      for (std::size_t g = 0; g < 6; ++g) fmt::print(" {:.3f} |", value(g, axis) / mm);
      fmt::print("\n");
    }
  };
  table("First seed", [&](std::size_t g, int axis) { return all[0][g].rms()[axis]; });
  table(fmt::format("RMS over {} seeds", seeds).c_str(), [&](std::size_t g, int axis) {
    double sum = 0.0;
    for (const auto& r : all) sum += std::pow(r[g].rms()[axis], 2);
    return std::sqrt(sum / double(all.size()));
  });
  table(fmt::format("Largest of {} seeds", seeds).c_str(), [&](std::size_t g, int axis) {
    double worst = 0.0;
    for (const auto& r : all) worst = std::max(worst, double(r[g].rms()[axis]));
    return worst;
  });
  Eigen::Array3d inside = Eigen::Array3d::Zero(), normalised = Eigen::Array3d::Zero();
  double count = 0.0, groups_above = 0.0;
  for (const auto& r : all) {
    for (const auto& g : r) {
      inside += g.inside;
      normalised += g.normalised;
      count += g.count;
      groups_above += g.rms().maxCoeff() > 1.0 * mm ? 1 : 0;
    }
  }
  fmt::print(
      "\ninside 1.96 sigma: north {:.1f} %, east {:.1f} %, vertical {:.1f} %; mean squared error over variance {:.2f} "
      "{:.2f} {:.2f}\ngroups above 1 mm in any direction: {} of {}\n",
      100 * inside[0] / count, 100 * inside[1] / count, 100 * inside[2] / count, normalised[0] / count,
      normalised[1] / count, normalised[2] / count, groups_above, 6 * all.size());
  return 0;
}

// --- 5 km tunnel
// --------------------------------------------------------------------------------------------------------

auto tunnel_motion(double spacing) {
  decltype(simulation::Scenario::motion) m;
  m.start = 20.0;
  m.stand = 900.0;
  m.legs.push_back({.to = 5120.0, .speed = 1.0, .stop = 30.0, .stop_every = spacing, .stop_each = 30.0});
  return m;
}

simulation::Scenario tunnel(double radius, double cant, double spacing) {
  simulation::Scenario s = base(30 * deg);
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

struct TunnelErrors {
  Squares straight, ramp, curve;
  void print(const char* name) const {
    const std::pair<const char*, const Squares*> rows[] = {
        {"straight", &straight}, {"ramps", &ramp}, {"curves", &curve}};
    for (const auto& [part, s] : rows) {
      const auto rms = s->rms();
      const auto share = s->inside / s->count;
      fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.0f} / {:.0f} / {:.0f} |\n", name, part, rms[0] / mm,
                 rms[1] / mm, rms[2] / mm, 100 * share[0], 100 * share[1], 100 * share[2]);
    }
  }
};

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

/// Both methods on one recording.
struct Solved {
  simulation::SimulatedRecording recording;
  fusion::LandmarkSolution reckoned;
  fusion::AidedInsResult aided;
};

/// What calibration left of the mounting is known to the programs as its sigma only.
Expected<Solved> solve(simulation::Scenario s, std::uint64_t seed, double mounting, bool with_aided) {
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
  if (!with_aided) return result;

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

/// RMS of the difference of the two methods, lateral, vertical, longitudinal.
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

int tunnel_study(std::uint64_t seed, double radius, double cant, double spacing, double mounting, double roughness) {
  simulation::Scenario s = tunnel(radius, cant, spacing);
  s.track.spectrum_factor = roughness;  // of the German low-disturbance spectrum
  const auto solved = solve(s, seed, mounting, true);
  if (!solved) return fmt::print(stderr, "{}\n", solved.error().message()), 1;
  fmt::print("\nR = {:.0f} m, cant {:.0f} mm, landmark every {:.0f} m, mounting off by {:.2f} mrad, seed {}\n\n",
             radius, cant / mm, spacing, mounting * 1e3, seed);
  fmt::print(
      "| method | part | lateral | vertical | longitudinal, mm | inside 1.96 sigma, % |\n|---|---|---|---|---|---|\n");
  judge(solved->reckoned.solution.smoothed, solved->recording, s).print("gyro/odometer/landmark");
  judge(solved->aided.solution.smoothed, solved->recording, s).print("aided INS");
  const auto d = difference(solved->reckoned.solution.smoothed, solved->aided.solution.smoothed);
  fmt::print("\ndifference of the methods, RMS: lateral {:.2f}, vertical {:.2f}, longitudinal {:.2f} mm\n", d[0] / mm,
             d[1] / mm, d[2] / mm);
  fmt::print("model error predicted, worst stretch: {:.2f} mm; rejected landmarks: {}\n",
             largest_model_error(solved->reckoned) / mm, solved->reckoned.solution.record.rejections.size());
  for (const auto& w : solved->reckoned.solution.record.warnings) fmt::print("warning: {}\n", w);
  for (const auto& v : solved->reckoned.observability.verdict) fmt::print("verdict: {}\n", v);
  return 0;
}

/// The tunnel with landmarks of 0.02 mm, quiet gyros and a smooth track, so that what is left is the reduced model's:
/// gyro bias, scale factor and misalignment, level, heading and mounting through curve and cant.
int validity_study(double mounting, int seeds) {
  fmt::print(
      "\n| R, m | cant, mm | landmark every, m | lateral | vertical, mm | to aided INS, lateral | vertical, mm | "
      "predicted, worst stretch, mm | warns |\n|---|---|---|---|---|---|---|---|---|\n");
  const std::pair<double, double> lines[] = {{inf, 0.0},     {3000.0, 60.0}, {800.0, 100.0},
                                             {400.0, 150.0}, {250.0, 150.0}, {150.0, 150.0}};
  for (const auto& [radius, cant] : lines) {
    for (const double spacing : {60.0, 120.0, 240.0}) {
      simulation::Scenario s = tunnel(radius, cant * mm, spacing);
      s.track.spectrum_factor = 1e-6;
      s.equipment.imu->errors.gyro.random_walk *= 0.02;
      s.equipment.total_station->sigma_position = 0.02 * mm;
      s.equipment.odometers[0].scale_walk = 0.0;
      s.equipment.odometers[0].quantum = 0.0;
      Eigen::Array2d squares = Eigen::Array2d::Zero(), apart = Eigen::Array2d::Zero();
      double predicted = 0.0;
      bool warns = false;
      for (int seed = 1; seed <= seeds; ++seed) {
        const auto solved = solve(s, std::uint64_t(seed), mounting, true);
        if (!solved) return fmt::print(stderr, "{}\n", solved.error().message()), 1;
        const TunnelErrors e = judge(solved->reckoned.solution.smoothed, solved->recording, s);
        Squares worst = e.straight;
        if (e.curve.count > 0.0) {
          worst = e.curve;
          worst.sum += e.ramp.sum;
          worst.count += e.ramp.count;
        }
        squares += worst.rms().head<2>().square() / seeds;
        apart +=
            difference(solved->reckoned.solution.smoothed, solved->aided.solution.smoothed).head<2>().square() / seeds;
        predicted = std::max(predicted, largest_model_error(solved->reckoned));
        for (const auto& w : solved->reckoned.solution.record.warnings) {
          warns = warns || w.find("reduced model") != std::string::npos;
        }
      }
      fmt::print("| {} | {:.0f} | {:.0f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {} |\n",
                 std::isfinite(radius) ? fmt::format("{:.0f}", radius) : "straight", cant, spacing,
                 std::sqrt(squares[0]) / mm, std::sqrt(squares[1]) / mm, std::sqrt(apart[0]) / mm,
                 std::sqrt(apart[1]) / mm, predicted / mm, warns ? "yes" : "no");
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const auto number = [&](int i, double otherwise) { return argc > i ? std::atof(argv[i]) : otherwise; };
  if (argc > 1 && std::strcmp(argv[1], "groups") == 0) return groups(static_cast<int>(number(2, 50)));
  if (argc > 1 && std::strcmp(argv[1], "tunnel") == 0) {
    return tunnel_study(static_cast<std::uint64_t>(number(2, 1)), number(3, 800.0), number(4, 100.0) * mm,
                        number(5, 60.0), number(6, 0.1) * 1e-3, number(7, 1.0));
  }
  if (argc > 1 && std::strcmp(argv[1], "validity") == 0) {
    return validity_study(number(2, 0.1) * 1e-3, static_cast<int>(number(3, 3)));
  }
  fmt::print(stderr,
             "usage: {} groups [SEEDS] | tunnel [SEED [RADIUS_M [CANT_MM [SPACING_M [MOUNTING_MRAD [ROUGHNESS]]]]]] |\n"
             "       validity [MOUNTING_MRAD [SEEDS]]\n",
             argv[0]);
  return 2;
}
