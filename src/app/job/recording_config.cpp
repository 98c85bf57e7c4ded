// SPDX-License-Identifier: Apache-2.0
#include "versine/app/recording_config.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "versine/core/text.hpp"
#include "versine/core/units.hpp"

namespace versine::app {

namespace {
using Names = std::string_view;

void describe_clock(ConfigVisitor& v, io::Clock& clock) {
  static constexpr std::array<std::pair<Names, TimeScale>, 3> scales{
      {{"gps", TimeScale::gps}, {"utc", TimeScale::utc}, {"recorder", TimeScale::recorder}}};
  v.choice<TimeScale>("time_scale", clock.scale, scales, {.doc = "What the time stamps count."});
  std::optional<double> week = clock.gps_week ? std::optional<double>(*clock.gps_week) : std::nullopt;
  v.value("gps_week", week,
          {.doc = "GPS week of the first stamp, where the file gives seconds of week only.", .min = 0, .max = 9999});
  if (week) clock.gps_week = static_cast<int>(*week);
  v.value("date", clock.date,
          {.doc = "Day of the first stamp, where the file gives times of day only.", .example = "\"2025-07-08\""});
  v.value("clock_offset_s", clock.offset_s,
          {.doc = "Added to every stamp; -0.125 for stamps that are 0.125 s late.", .unit = "s"});
  v.value("clock_drift_ppm", clock.drift_ppm,
          {.doc = "Further added, per second since the first stamp.", .unit = "ppm", .min = -1e4, .max = 1e4});
}

void describe_table(ConfigVisitor& v, InputPath& file, io::TableFile& table, bool required) {
  v.value("file", file,
          {.doc = "The recording; plain, gzip or zstd.", .required = required, .example = "\"recording.csv\""});
  table.path = file.path;
  v.value("columns", table.columns,
          {.doc = "Versine's column names to the file's own headers, or to column numbers from 1 in a file without "
                  "header: { gyro_x_degps = \"gx\" }."});
  int skip = static_cast<int>(table.skip_lines);
  v.value("skip_lines", skip, {.doc = "Leading lines to pass over.", .min = 0});
  table.skip_lines = static_cast<std::size_t>(skip);
  v.value("delimiter", table.delimiter, {.doc = "One character, or \"blank\"; none: found from the first lines."});
  describe_clock(v, table.clock);
}

void describe_frame(ConfigVisitor& v, io::PositionFrame& frame) {
  std::vector<double> origin;
  if (frame.origin) {
    origin = {frame.origin->latitude / units::deg, frame.origin->longitude / units::deg, frame.origin->height};
  }
  v.value("origin", origin,
          {.doc = "Latitude, longitude (deg) and height (m) that north_m, east_m and down_m count "
                  "from.",
           .example = "[48.1, 11.5, 520.0]"});
  if (origin.size() == 3) frame.origin = {origin[0] * units::deg, origin[1] * units::deg, origin[2]};
  v.value("crs", frame.crs, {.doc = "Projected CRS of easting_m and northing_m.", .example = "\"EPSG:25832\""});
}

constexpr KeySpec sigma_m(std::string_view doc) {
  return {.doc = doc, .unit = "m", .max = 1e4, .positive = true};
}
}  // namespace

void describe(ConfigVisitor& v, ImuFileConfig& c) {
  io::ImuFile& d = c.description;
  describe_table(v, c.file, d.table, true);
  static constexpr std::array<std::pair<Names, io::ImuFile::Format>, 2> formats{
      {{"csv", io::ImuFile::Format::csv}, {"kf-gins", io::ImuFile::Format::kf_gins}}};
  v.choice<io::ImuFile::Format>("format", d.format, formats, {.doc = "Layout of the file."});
  v.value("axes", d.axes, {.doc = "Where the sensor's x, y and z point."});
  std::string accel_axes = d.accel_axes.value_or("");
  v.value("accel_axes", accel_axes, {.doc = "The same for the accelerometers, when their axes differ."});
  if (!accel_axes.empty()) d.accel_axes = accel_axes;
  std::vector<double> rotation;
  v.value("rotation", rotation,
          {.doc = "Instead of axes: nine numbers, row by row, of the rotation from the sensor's "
                  "axes to forward-right-down.",
           .min = -1,
           .max = 1});
  if (rotation.size() == 9)
    d.rotation = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation.data());
  v.value("gyro_scale", d.gyro_scale, {.doc = "Factor from the numbers in the file to the unit in the column's name."});
  v.value("accel_scale", d.accel_scale, {.doc = "The same for the accelerometers."});
  static constexpr std::array<std::pair<Names, io::ImuFile::Rate>, 2> rates{
      {{"mean", io::ImuFile::Rate::mean}, {"at-stamp", io::ImuFile::Rate::at_stamp}}};
  v.choice<io::ImuFile::Rate>("rates_are", d.rate, rates,
                              {.doc = "Rates are means over the interval before the stamp, or values at it."});
  v.value("rate_hz", d.rate_hz,
          {.doc = "Sampling rate, for a file without time column.", .unit = "Hz", .max = 1e5, .positive = true});
  v.value("start_s", d.start_s, {.doc = "Time of the first sample, for a file without time column.", .unit = "s"});
}

void describe(ConfigVisitor& v, GnssFileConfig& c) {
  io::GnssFile& d = c.description;
  describe_table(v, c.file, d.table, false);
  using Format = io::GnssFile::Format;
  static constexpr std::array<std::pair<Names, Format>, 5> formats{{{"auto", Format::automatic},
                                                                    {"csv", Format::csv},
                                                                    {"rtklib", Format::rtklib},
                                                                    {"nmea", Format::nmea},
                                                                    {"kf-gins", Format::kf_gins}}};
  v.choice<Format>("format", d.format, formats, {.doc = "Layout of the file."});
  describe_frame(v, d.frame);
  v.value("sigma_horizontal_m", d.sigma_horizontal, sigma_m("Of north and east each, where the file gives none."));
  v.value("sigma_vertical_m", d.sigma_vertical, sigma_m("Of the height, where the file gives none."));
  v.value("sigma_velocity_mps", d.sigma_velocity,
          {.doc = "Of each velocity component, where the file gives none.", .unit = "m/s", .positive = true});
  v.value("sigma_range_m", d.sigma_range, sigma_m("Of a range, where the file gives dilutions of precision only."));
}

void describe(ConfigVisitor& v, OdometerFileConfig& c) {
  describe_table(v, c.file, c.description.table, false);
  v.value("metres_per_count", c.description.metres_per_count,
          {.doc = "Distance of one count, pulse or quadrature step; negative when it counts backwards.", .unit = "m"});
  v.value("counter_bits", c.description.counter_bits,
          {.doc = "Width of a counter that wraps around; 0: it does not.", .min = 0, .max = 64});
}

void describe(ConfigVisitor& v, SpeedFileConfig& c) {
  describe_table(v, c.file, c.description.table, false);
}
void describe(ConfigVisitor& v, GaugeFileConfig& c) {
  describe_table(v, c.file, c.description.table, false);
}
void describe(ConfigVisitor& v, RangeFileConfig& c) {
  describe_table(v, c.file, c.description.table, false);
}

void describe(ConfigVisitor& v, HeadingFileConfig& c) {
  describe_table(v, c.file, c.description.table, false);
  v.value("sigma_heading_deg", c.description.sigma,
          {.doc = "Where the file gives none.", .unit = "deg", .scale = units::deg, .positive = true});
}

void describe(ConfigVisitor& v, LandmarkFileConfig& c) {
  describe_table(v, c.file, c.description.table, false);
  describe_frame(v, c.description.frame);
  v.value("sigma_horizontal_m", c.description.sigma_horizontal,
          sigma_m("Of north and east each, where the file gives "
                  "none."));
  v.value("sigma_vertical_m", c.description.sigma_vertical, sigma_m("Of the height, where the file gives none."));
}

void describe(ConfigVisitor& v, TrajectoryFileConfig& c) {
  describe_table(v, c.file, c.description.table, true);
  describe_frame(v, c.description.frame);
}

namespace {
void describe_triad(ConfigVisitor& v, ImuErrorsConfig::Triad& t, bool gyro) {
  const auto spec = [](std::string_view doc, std::string_view unit, double scale) {
    return KeySpec{.doc = doc, .unit = unit, .scale = scale, .min = 0.0};
  };
  if (gyro) {
    v.value("bias_degph", t.bias, spec("Sigma of the constant bias.", "deg/h", units::deg_per_hour));
    v.value("random_walk_degpsqrth", t.random_walk,
            spec("Angle random walk.", "deg/sqrt(h)", units::deg_per_sqrt_hour));
    v.value("bias_instability_degph", t.bias_instability,
            spec("Sigma of the slowly varying bias.", "deg/h", units::deg_per_hour));
    v.value("rate_random_walk_degphpsqrth", t.rate_random_walk,
            spec("Random walk of the bias.", "deg/h/sqrt(h)", units::deg_per_hour / 60.0));
  } else {
    v.value("bias_mgal", t.bias, spec("Sigma of the constant bias.", "mGal", units::mGal));
    v.value("random_walk_mpspsqrth", t.random_walk,
            spec("Velocity random walk.", "m/s/sqrt(h)", units::mps_per_sqrt_hour));
    v.value("bias_instability_mgal", t.bias_instability,
            spec("Sigma of the slowly varying bias.", "mGal", units::mGal));
    v.value("rate_random_walk_mgalpsqrth", t.rate_random_walk,
            spec("Random walk of the bias.", "mGal/sqrt(h)", units::mGal / 60.0));
  }
  v.value("correlation_time_s", t.correlation_time,
          {.doc = "Of the slowly varying bias (first-order Gauss-Markov).", .unit = "s", .positive = true});
  v.value("scale_factor_ppm", t.scale_factor, spec("Sigma of the scale factor error.", "ppm", units::ppm));
  v.value("misalignment_arcsec", t.misalignment,
          spec("Sigma of each angle of non-orthogonality.", "arcsec", units::arcsec));
}

sensors::TriadErrors with(sensors::TriadErrors e, const ImuErrorsConfig::Triad& t) {
  e.bias = t.bias.value_or(e.bias);
  e.random_walk = t.random_walk.value_or(e.random_walk);
  e.bias_instability = t.bias_instability.value_or(e.bias_instability);
  e.correlation_time = t.correlation_time.value_or(e.correlation_time);
  e.rate_random_walk = t.rate_random_walk.value_or(e.rate_random_walk);
  e.scale_factor = t.scale_factor.value_or(e.scale_factor);
  e.misalignment = t.misalignment.value_or(e.misalignment);
  return e;
}
}  // namespace

void describe(ConfigVisitor& v, ImuErrorsConfig& c) {
  v.value("grade", c.grade,
          {.doc = "Class of the instrument: perfect, navigation-rlg, rlg-jiang, fog, tactical or mems; single values "
                  "below override it."});
  v.table("gyro", "Gyroscope errors that differ from the grade's.",
          [&](ConfigVisitor& t) { describe_triad(t, c.gyro, true); });
  v.table("accelerometer", "Accelerometer errors that differ from the grade's.",
          [&](ConfigVisitor& t) { describe_triad(t, c.accelerometer, false); });
}

Expected<sensors::ImuErrors> ImuErrorsConfig::errors() const {
  const auto found = sensors::find_imu_grade(grade);
  if (!found) {
    std::vector<std::string_view> names;
    for (const auto& known : sensors::imu_grades()) names.push_back(known.name);
    const std::string_view near = nearest(grade, names);
    return fail({.field = "grade",
                 .found = fmt::format("'{}'", grade),
                 .expected = fmt::format("one of {}", fmt::join(names, ", ")),
                 .advice = near.empty() ? "" : fmt::format("did you mean '{}'?", near)});
  }
  return sensors::ImuErrors{with(found->errors.gyro, gyro), with(found->errors.accelerometer, accelerometer)};
}

}  // namespace versine::app
