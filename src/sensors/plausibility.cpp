// SPDX-License-Identifier: Apache-2.0
#include "versine/sensors/plausibility.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "versine/core/calendar.hpp"
#include "versine/core/units.hpp"

namespace versine::sensors {

namespace {
constexpr double g0 = units::standard_gravity;

/// Means over a second.
struct Second {
  Eigen::Vector3d force, rate;  ///< m/s^2, rad/s
  double unrest;                ///< largest departure of the specific force from its mean, m/s^2
};

std::vector<Second> seconds_of(const CheckedImu& imu) {
  std::vector<Second> seconds;
  const double interval = imu.series.interval.seconds();
  const auto width = std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(1.0 / interval)));
  for (const Segment& segment : imu.segments) {
    for (std::size_t i = segment.begin; i + width <= segment.end; i += width) {
      Eigen::Vector3d dvel = Eigen::Vector3d::Zero(), dtheta = Eigen::Vector3d::Zero();
      for (std::size_t k = i; k < i + width; ++k) dvel += imu.series[k].dvel, dtheta += imu.series[k].dtheta;
      const double span = interval * static_cast<double>(width);
      const Eigen::Vector3d mean = dvel / static_cast<double>(width);
      double unrest = 0.0;
      for (std::size_t k = i; k < i + width; ++k) unrest += (imu.series[k].dvel - mean).squaredNorm();
      seconds.push_back({dvel / span, dtheta / span, std::sqrt(unrest / static_cast<double>(width)) / interval});
    }
  }
  return seconds;
}

// The calmest tenth of the recording, at least three seconds of it.
std::vector<Second> calmest(std::vector<Second> seconds) {
  const std::size_t n = std::min(seconds.size(), std::max<std::size_t>(3, seconds.size() / 10));
  std::partial_sort(seconds.begin(), seconds.begin() + static_cast<std::ptrdiff_t>(n), seconds.end(),
                    [](const Second& a, const Second& b) { return a.unrest < b.unrest; });
  seconds.resize(n);
  return seconds;
}

/// What a wrong declaration makes of 1 g.
struct Mistake {
  double size;  ///< m/s^2
  const char* is;
  const char* advice;
};

Expected<void> gravity_size(double size, double interval, const std::string& file) {
  if (size > 0.95 * g0 && size < 1.05 * g0) return {};
  const std::array mistakes{
      Mistake{1.0, "g declared as m/s^2", "name the columns accel_x_g, accel_y_g, accel_z_g"},
      Mistake{g0 * g0, "m/s^2 declared as g", "name the columns accel_x_mps2, accel_y_mps2, accel_z_mps2"},
      Mistake{g0 * interval, "increments of velocity declared as accelerations",
              "name the columns dvel_x_mps, dvel_y_mps, dvel_z_mps"},
      Mistake{g0 / interval, "accelerations declared as increments of velocity",
              "name the columns accel_x_mps2, accel_y_mps2, accel_z_mps2"},
      Mistake{1e-3, "thousands of g declared as g or m/s^2", "check accel_scale and the unit"},
      Mistake{1e3 * g0, "mg declared as g", "name the columns accel_x_mg, accel_y_mg, accel_z_mg"}};
  std::string advice = "check the unit of the accelerometers and accel_scale";
  std::string found = fmt::format("a specific force of {:.4g} m/s^2 in the calmest part of the recording", size);
  for (const Mistake& m : mistakes) {
    if (std::abs(size / m.size - 1.0) < 0.05) {
      found += std::string("; this looks like ") + m.is;
      advice = m.advice;
      break;
    }
  }
  return fail(
      {.file = file, .field = "accel", .found = found, .expected = "gravity, 9.3 to 10.3 m/s^2", .advice = advice});
}

// The words for axes that would bring `force` (which must point up when standing) in order, given the present words.
std::string direction_of(const Eigen::Vector3d& force) {
  Eigen::Index axis = 0;
  force.cwiseAbs().maxCoeff(&axis);
  constexpr std::array positive{"forward", "right", "down"}, negative{"backward", "left", "up"};
  const auto at = static_cast<std::size_t>(axis);
  return force[axis] > 0.0 ? positive[at] : negative[at];
}

Expected<void> gravity_direction(const Eigen::Vector3d& force, const ImuPlausibilityOptions& options) {
  const double tilt = std::acos(std::clamp(-force.z() / force.norm(), -1.0, 1.0));
  if (tilt <= options.max_tilt) return {};
  const std::string shown = direction_of(force);
  return fail(
      {.file = options.file,
       .field = "axes",
       .found = fmt::format("gravity along the axis declared as {} ({:.2f}, {:.2f}, {:.2f} m/s^2 forward, right, "
                            "down in the calmest part)",
                            shown, force.x(), force.y(), force.z()),
       .expected = fmt::format("the sensors to read 1 g upward, within {:.0f} deg", options.max_tilt / units::deg),
       .advice =
           fmt::format("correct axes: the sensor axis that is declared as {} points up in truth{}", shown,
                       shown == std::string("down") ? "; for sensors with z up, \"right-forward-up\" is usual"
                                                    : "; \"forward-right-down\" and \"right-forward-up\" are usual")});
}

// Gyroscopes good enough to see the Earth turn show its rate while they stand; in degrees that was declared as radians
// it is 57.3 times as much. Four of five calm seconds must agree, so that no curve is taken for it.
bool shows_earth_in_degrees(const std::vector<Second>& calm, const ImuPlausibilityOptions& options) {
  constexpr double earth = 7.292e-5;  // rad/s
  if (!(options.gyro_bias > 0.0) || !(options.gyro_bias < 0.1 * earth)) return false;
  const double tolerance = std::max(0.15 * earth, 5.0 * options.gyro_bias);
  const auto alike = std::count_if(calm.begin(), calm.end(), [&](const Second& s) {
    return std::abs(s.rate.norm() * units::deg - earth) < tolerance;
  });
  return static_cast<double>(alike) > 0.8 * static_cast<double>(calm.size());
}

Expected<void> rates_of_a_vehicle(const std::vector<Second>& all, const std::vector<Second>& calm, double interval,
                                  const ImuPlausibilityOptions& options) {
  std::vector<double> rates;
  for (const Second& s : all) rates.push_back(s.rate.norm());
  const auto at = rates.begin() + static_cast<std::ptrdiff_t>(rates.size() * 19 / 20);
  std::nth_element(rates.begin(), at, rates.end());
  std::vector<double> still;
  for (const Second& s : calm) still.push_back(s.rate.norm());
  std::nth_element(still.begin(), still.begin() + static_cast<std::ptrdiff_t>(still.size() / 2), still.end());
  const double standing = still[still.size() / 2];
  const bool lively = *at > options.max_mean_rate;
  if (!lively && shows_earth_in_degrees(calm, options)) {
    return fail({.file = options.file,
                 .field = "gyro",
                 .found = fmt::format("a standing rate of {:.3g} rad/s, 57.3 times that of the Earth", standing),
                 .expected = "7.3e-5 rad/s, the Earth's rate, from gyroscopes of this grade at rest",
                 .advice = "the numbers look like degrees declared as radians: name the columns gyro_x_degps (or "
                           "_degph, or dtheta_x_deg)"});
  }
  if (!lively && !(standing > options.max_standing_rate)) return {};
  const double rate = lively ? *at : standing;
  return fail(
      {.file = options.file,
       .field = "gyro",
       .found = fmt::format("angular rates of {:.3g} rad/s {}", rate,
                            lively ? "in a twentieth of the recording" : "in the calmest part of the recording"),
       .expected = lively ? fmt::format("at most {:.2g} rad/s of a vehicle", options.max_mean_rate)
                          : fmt::format("at most {:.2g} rad/s", options.max_standing_rate),
       .advice = rate * interval > 1e3 * interval && rate > 1e3
                     ? "check the unit and gyro_scale"
                     : "the numbers look like degrees declared as radians: name the columns gyro_x_degps (or "
                       "_degph, or dtheta_x_deg)"});
}

std::string clock_name(TimeScale scale) {
  return scale == TimeScale::recorder ? "the recorder's own time" : "GPS time";
}
}  // namespace

Expected<void> check_overlap(std::span<const Extent> extents) {
  if (extents.empty()) return {};
  const Extent& first = extents.front();
  for (const Extent& other : extents.subspan(1)) {
    if (other.scale != first.scale) {
      return fail({.file = other.file,
                   .field = "time",
                   .found = fmt::format("{} in {} and {} in {}", other.sensor, clock_name(other.scale), first.sensor,
                                        clock_name(first.scale)),
                   .expected = "one time scale",
                   .advice =
                       "set gps_week for a file that has seconds of week only, date for one that has times of day, "
                       "or time_scale = \"recorder\" for both when one clock stamped them"});
    }
    if (other.from <= first.to && other.to >= first.from) continue;
    const double apart = other.from > first.to ? (other.from - first.to).seconds() : (first.from - other.to).seconds();
    const double seconds_in_week = one_week.seconds();
    const bool weeks = std::abs(std::remainder(apart, seconds_in_week)) < 86400.0 && apart > 0.9 * seconds_in_week;
    const bool leap = apart < 60.0;
    return fail(
        {.file = other.file,
         .field = "time",
         .found = fmt::format("{} from {} to {}, {} from {} to {}: {:.6g} s apart", other.sensor,
                              to_text(other.from, other.scale), to_text(other.to, other.scale), first.sensor,
                              to_text(first.from, first.scale), to_text(first.to, first.scale), apart),
         .expected = "recordings of the same time",
         .advice = weeks  ? "the week looks wrong: correct gps_week"
                   : leap ? "check time_scale (GPS is 18 s ahead of UTC) and clock_offset_s"
                          : "check that the files are of one journey, and time_scale, gps_week and clock_offset_s"});
  }
  return {};
}

Expected<RunRecord> check_imu_plausibility(const CheckedImu& imu, const ImuPlausibilityOptions& options) {
  RunRecord record;
  const std::vector<Second> all = seconds_of(imu);
  if (all.empty()) {
    record.warnings.push_back("imu: less than a second of data in a row; units and axes were not checked");
    return record;
  }
  const std::vector<Second> calm = calmest(all);
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  double size = 0.0;
  for (const Second& s : calm) force += s.force, size += s.force.norm();
  force /= static_cast<double>(calm.size());
  size /= static_cast<double>(calm.size());
  const double interval = imu.series.interval.seconds();
  if (const auto fine = gravity_size(size, interval, options.file); !fine) return tl::unexpected(fine.error());
  if (const auto fine = gravity_direction(force, options); !fine) return tl::unexpected(fine.error());
  if (const auto fine = rates_of_a_vehicle(all, calm, interval, options); !fine) return tl::unexpected(fine.error());
  return record;
}

}  // namespace versine::sensors
