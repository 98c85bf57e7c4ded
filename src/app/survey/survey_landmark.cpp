// SPDX-License-Identifier: Apache-2.0
#include "versine/app/survey_landmark.hpp"

#include <array>
#include <cmath>

#include "versine/core/units.hpp"
#include "versine/fusion/landmark_dead_reckoning.hpp"

namespace versine::app {

namespace {
using namespace units;
constexpr std::array<std::pair<std::string_view, fusion::LandmarkSmoother>, 2> smoothers{
    {{"rts", fusion::LandmarkSmoother::rts}, {"two-filter", fusion::LandmarkSmoother::two_filter}}};
}  // namespace

void describe(ConfigVisitor& v, fusion::LandmarkOptions& o) {
  v.choice<fusion::LandmarkSmoother>("smoother", o.smoother, smoothers,
                                     {.doc = "Rauch-Tung-Striebel or two filters; the results are the same."});
  v.value("pitch_sigma_deg", o.pitch_sigma,
          {.doc = "Level and pitch mounting at the start, 1 sigma.",
           .unit = "deg",
           .scale = deg,
           .max = 5,
           .positive = true});
  v.value("bias_sigma_deg_per_h", o.bias_sigma,
          {.doc = "Gyro bias left by the standing start, 1 sigma; default: from the gyro's errors and the time stood.",
           .unit = "deg/h",
           .scale = deg_per_hour,
           .max = 1e4,
           .positive = true});
  v.value("mounting_sigma_mrad", o.mounting_sigma,
          {.doc = "Each mounting angle after calibration, 1 sigma; it limits the method where cant changes.",
           .unit = "mrad",
           .scale = 1e-3,
           .min = 0,
           .max = 50});
  v.value("path_noise_mm_per_sqrt_m", o.path_walk,
          {.doc = "How far the wheels stray, sideways and up, from the direction they point in.",
           .unit = "mm/sqrt(m)",
           .scale = mm,
           .min = 0,
           .max = 100});
  v.value("gate", o.gate,
          {.doc = "Largest normalised residual of a landmark that is used.", .max = 1e6, .positive = true});
  v.value("standing_tolerance_mm", o.standing_tolerance,
          {.doc = "What the odometer may show while the trolley stands.",
           .unit = "mm",
           .scale = mm,
           .max = 100,
           .positive = true});
  v.value("skip_moving_landmarks", o.skip_moving_landmarks,
          {.doc = "Leave out a landmark taken in motion instead of stopping with an error."});
  v.value("model_error_limit_mm", o.model_error_limit,
          {.doc = "Where the reduced model may be off by more, the run warns.",
           .unit = "mm",
           .scale = mm,
           .max = 100,
           .positive = true});
}

fusion::LandmarkOptions landmark_options(const fusion::AidedInsOptions& shared, fusion::LandmarkOptions own) {
  own.gyro = shared.imu_errors.gyro;
  own.levelling_sigma = std::max(shared.imu_errors.accelerometer.bias / standard_gravity, 1e-6);
  own.alignment_duration = shared.alignment_duration;
  if (shared.initial_heading) {
    own.heading = shared.initial_heading;
    own.heading_sigma = shared.initial_heading_sigma;
  }
  own.scale_sigma = shared.odometer_scale_sigma;
  if (shared.odometer_scale_walk > 0.0) own.scale_walk = shared.odometer_scale_walk;
  own.distance_walk = shared.odometer_random_walk;
  own.odometer_resolution = shared.odometer_sigma * std::sqrt(12.0);
  own.mounting = shared.mounting;
  if (shared.mounting_sigma > 0.0) own.mounting_sigma = shared.mounting_sigma;
  own.lever_odometer = shared.wheel_lever.l_b;
  own.lever_landmark = shared.landmark_lever.l_b;
  own.output_rate = shared.output_rate;
  own.chain_interval = shared.chain_rate > 0.0 ? 1.0 / shared.chain_rate : 0.0;
  return own;
}

Expected<fusion::AidedInsResult> solve_by_landmarks(const fusion::AidedInsInput& input,
                                                    const fusion::AidedInsOptions& shared,
                                                    const fusion::LandmarkOptions& own, Progress& progress) {
  auto solved = fusion::run_landmark_dead_reckoning(
      {.imu = &input.imu, .odometer = &input.odometer, .landmarks = &input.landmarks}, landmark_options(shared, own),
      progress);
  if (!solved) return tl::unexpected(solved.error());
  fusion::AidedInsResult result;
  result.solution = std::move(solved->solution);
  if (!input.gnss.empty() || !input.speed.empty() || !input.heading.empty()) {
    result.solution.record.warnings.push_back(
        "GNSS, speed and heading of this job are not used: method = \"landmark\" works with gyros, odometer and "
        "landmarks. The aided INS uses them all.");
  }
  return result;
}

}  // namespace versine::app
