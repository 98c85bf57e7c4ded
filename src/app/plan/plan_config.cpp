// SPDX-License-Identifier: Apache-2.0
#include "versine/app/plan_config.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "versine/core/text.hpp"
#include "versine/core/units.hpp"

namespace versine::app {

namespace {

using namespace units;

constexpr double micro_g = 1e-6 * standard_gravity;
constexpr std::array<std::pair<std::string_view, fusion::PlanBasis>, 2> bases{
    {{"interval", fusion::PlanBasis::interval}, {"chain", fusion::PlanBasis::chain}}};

void describe_sensors(ConfigVisitor& v, PlanConfig& c) {
  v.value("grade", c.grade,
          {.doc = "Class of the IMU, which gives every error that is not given below: navigation-rlg, rlg-jiang, fog, "
                  "tactical, mems."});
  v.value("gyro_bias_deg_per_h", c.gyro_bias,
          {.doc = "Gyro bias that remains after calibration; it limits gyrocompassing.",
           .unit = "deg/h",
           .scale = deg_per_hour,
           .max = 1000,
           .positive = true});
  v.value(
      "gyro_random_walk_deg_per_sqrt_h", c.gyro_random_walk,
      {.doc = "Angle random walk.", .unit = "deg/sqrt(h)", .scale = deg_per_sqrt_hour, .max = 100, .positive = true});
  v.value("gyro_bias_instability_deg_per_h", c.gyro_bias_instability,
          {.doc = "Drift of the bias within a run.", .unit = "deg/h", .scale = deg_per_hour, .min = 0, .max = 1000});
  v.value("accelerometer_bias_ug", c.accelerometer_bias,
          {.doc = "Accelerometer bias, for levelling and for the inertial methods.",
           .unit = "ug",
           .scale = micro_g,
           .max = 1e5,
           .positive = true});
  v.value("accelerometer_random_walk_ug_per_sqrt_hz", c.accelerometer_random_walk,
          {.doc = "Accelerometer noise, for the inertial methods.",
           .unit = "ug/sqrt(Hz)",
           .scale = micro_g,
           .max = 1e4,
           .positive = true});
  v.value("level_error_deg", c.plan.level,
          {.doc = "Error of level and pitch mounting at the start, 1 sigma.",
           .unit = "deg",
           .scale = deg,
           .max = 1,
           .positive = true});
  v.value("odometer_scale_ppm", c.plan.scale,
          {.doc = "Error of the odometer's scale factor at the start, 1 sigma.",
           .unit = "ppm",
           .scale = ppm,
           .max = 1e5,
           .positive = true});
  v.value("odometer_scale_walk_ppm_per_sqrt_s", c.plan.scale_walk,
          {.doc = "Random walk of that scale factor.", .unit = "ppm/sqrt(s)", .scale = ppm, .min = 0, .max = 1e4});
  v.value("odometer_noise_mm_per_sqrt_m", c.plan.distance_walk,
          {.doc = "Random error of distance besides the scale factor.",
           .unit = "mm/sqrt(m)",
           .scale = mm,
           .min = 0,
           .max = 100});
  v.value("path_noise_mm_per_sqrt_m", c.plan.path_walk,
          {.doc = "How far the wheels stray, sideways and up, from the direction they point in.",
           .unit = "mm/sqrt(m)",
           .scale = mm,
           .min = 0,
           .max = 100});
}

void describe_survey(ConfigVisitor& v, PlanConfig& c) {
  auto& p = c.plan;
  v.value("landmark_sigma_mm", p.landmark,
          {.doc = "Standard deviation of a landmark in each direction.",
           .unit = "mm",
           .scale = mm,
           .max = 1000,
           .positive = true});
  v.value("spacing_m", p.spacing, {.doc = "Distance from landmark to landmark.", .unit = "m", .min = 1, .max = 5000});
  v.value("intervals", p.intervals, {.doc = "How many such distances the run has.", .min = 1, .max = 200});
  v.value("speed_kmh", p.speed,
          {.doc = "Speed between landmarks.", .unit = "km/h", .scale = kmh, .max = 400, .positive = true});
  v.value("stand_s", p.stand, {.doc = "Standing at each landmark.", .unit = "s", .min = 0, .max = 3600});
  v.value("latitude_deg", p.latitude,
          {.doc = "Where the survey is; gyrocompassing weakens towards the poles.",
           .unit = "deg",
           .scale = deg,
           .min = -85,
           .max = 85});
  v.value("heading_deg", p.heading,
          {.doc = "Direction of the track from north.", .unit = "deg", .scale = deg, .min = -360, .max = 360});
}

void describe_monte_carlo(ConfigVisitor& v, PlanMonteCarloConfig& m) {
  v.value("runs", m.runs,
          {.doc = "Simulated surveys; 0: none. --monte-carlo N sets it too.", .min = 0, .max = 1000000});
  v.value("seed", m.seed, {.doc = "Of the random numbers.", .min = 0, .max = 9e15});
  v.value("imu_rate_hz", m.imu_rate, {.doc = "Samples of the simulated IMU.", .unit = "Hz", .min = 20, .max = 1000});
  v.value("static_start_s", m.static_start,
          {.doc = "Standing alignment in each run; 0: the attitude is given with the errors planned.",
           .unit = "s",
           .min = 0,
           .max = 3600});
  v.value("flicker", m.flicker, {.doc = "Bias instability as flicker noise (1/f) instead of Gauss-Markov."});
  v.value("bias_deg_per_h", m.bias,
          {.doc = "Constant gyro bias of the simulation, 1 sigma, when it is not the planned one.",
           .unit = "deg/h",
           .scale = deg_per_hour,
           .min = 0,
           .max = 1000});
  v.value("random_walk_deg_per_sqrt_h", m.random_walk,
          {.doc = "Angle random walk of the simulation, when it is not the planned one.",
           .unit = "deg/sqrt(h)",
           .scale = deg_per_sqrt_hour,
           .min = 0,
           .max = 100});
  v.value("bias_instability_deg_per_h", m.bias_instability,
          {.doc = "Bias instability of the simulation, when it is not the planned one; with flicker the coefficient B "
                  "of IEEE 952 (the floor of the Allan deviation is 0.664 B).",
           .unit = "deg/h",
           .scale = deg_per_hour,
           .min = 0,
           .max = 1000});
  v.value("rate_random_walk_deg_per_h_per_sqrt_s", m.rate_random_walk,
          {.doc = "Rate random walk of the simulation, when it is not the planned one.",
           .unit = "deg/h/sqrt(s)",
           .scale = deg_per_hour,
           .min = 0,
           .max = 100});
}

}  // namespace

PlanConfig::PlanConfig() {
  map_bias = 0.3 * deg_per_hour;
  map_random_walk = 0.03 * deg_per_sqrt_hour;
  map_scale = 0.004;
  map_scale_walk = 20e-6;
  plan.level = 0.005 * deg;
  plan.landmark = 0.6 * mm;
  plan.latitude = 50.0 * deg;
}

void describe(ConfigVisitor& v, PlanConfig& c) {
  v.value("job", c.job, {.doc = "What this file is.", .required = true, .example = "\"plan\""});
  v.value("title", c.title, {.doc = "For tables and figures."});
  v.value("required_sigma_mm", c.required,
          {.doc = "Standard deviation that lateral and vertical position have to keep everywhere.",
           .unit = "mm",
           .scale = mm,
           .max = 1000,
           .positive = true});
  v.choice<fusion::PlanBasis>("basis", c.basis, bases,
                              {.doc = "Judge by one interval by itself (the first of a survey), or by the middle of "
                                      "the chained run."});
  v.value("chord_m", c.chord,
          {.doc = "Chord of the versine whose sigma is predicted; 0: none.", .unit = "m", .min = 0, .max = 1000});
  v.value("compare_methods", c.compare_methods,
          {.doc = "Also inertial navigation with landmarks, with and without odometer."});
  v.table("sensors", "IMU and odometer.", [&](ConfigVisitor& t) { describe_sensors(t, c); });
  v.table("survey", "What will be done with them.", [&](ConfigVisitor& t) { describe_survey(t, c); });
  v.table(
      "maps", "Sigma at mid-interval over the size of two errors, from zero to these values.", [&](ConfigVisitor& t) {
        t.value("points", c.map_points, {.doc = "Grid points in each direction.", .min = 2, .max = 501});
        t.value("bias_deg_per_h", c.map_bias,
                {.doc = "Largest gyro bias.", .unit = "deg/h", .scale = deg_per_hour, .max = 1e4, .positive = true});
        t.value("random_walk_deg_per_sqrt_h", c.map_random_walk,
                {.doc = "Largest random walk.",
                 .unit = "deg/sqrt(h)",
                 .scale = deg_per_sqrt_hour,
                 .max = 100,
                 .positive = true});
        t.value("odometer_scale_ppm", c.map_scale,
                {.doc = "Largest scale factor error.", .unit = "ppm", .scale = ppm, .max = 1e5, .positive = true});
        t.value(
            "odometer_scale_walk_ppm_per_sqrt_s", c.map_scale_walk,
            {.doc = "Largest random walk of it.", .unit = "ppm/sqrt(s)", .scale = ppm, .max = 1e4, .positive = true});
      });
  v.table("monte_carlo", "Simulated surveys through the real filters.",
          [&](ConfigVisitor& t) { describe_monte_carlo(t, c.monte_carlo); });
  v.table(
      "report", "A report beside the result (docs/report.md); without this table none is made.",
      [&](ConfigVisitor& t) { describe(t, c.report, false); }, &c.report.present);
}

Expected<PlanConfig> read_plan_config(const std::filesystem::path& path, std::span<const std::string> overrides) {
  PlanConfig c;
  if (auto done = read_config(
          path, [&](ConfigVisitor& v) { describe(v, c); }, overrides);
      !done) {
    return tl::unexpected(done.error());
  }
  const auto grade = sensors::find_imu_grade(c.grade);
  if (!grade || !(grade->errors.gyro.random_walk > 0.0)) {
    std::vector<std::string_view> names;
    std::string list;
    for (const auto& g : sensors::imu_grades()) {
      if (!(g.errors.gyro.random_walk > 0.0)) continue;
      names.push_back(g.name);
      list += (list.empty() ? "" : ", ") + std::string(g.name);
    }
    const auto near = nearest(c.grade, names);
    return fail({.file = path.string(),
                 .field = "sensors.grade",
                 .found = "'" + c.grade + "'",
                 .expected = "one of " + list,
                 .advice = near.empty() ? "or give the gyro's errors by value with any of these as a base"
                                        : fmt::format("did you mean '{}'?", near)});
  }
  c.plan.gyro = grade->errors.gyro;
  c.plan.accelerometer = grade->errors.accelerometer;
  c.plan.gyro.bias = c.gyro_bias.value_or(c.plan.gyro.bias);
  c.plan.gyro.random_walk = c.gyro_random_walk.value_or(c.plan.gyro.random_walk);
  c.plan.gyro.bias_instability = c.gyro_bias_instability.value_or(c.plan.gyro.bias_instability);
  c.plan.accelerometer.bias = c.accelerometer_bias.value_or(c.plan.accelerometer.bias);
  c.plan.accelerometer.random_walk = c.accelerometer_random_walk.value_or(c.plan.accelerometer.random_walk);
  if (c.chord > c.plan.spacing * c.plan.intervals) {
    return fail({.file = path.string(),
                 .field = "chord_m",
                 .found = fmt::format("{} m", c.chord),
                 .expected = fmt::format("a chord within the run of {} m", c.plan.spacing * c.plan.intervals),
                 .advice = "shorten the chord or plan more intervals"});
  }
  return c;
}

}  // namespace versine::app
