// SPDX-License-Identifier: Apache-2.0
#include "versine/app/geometry_config.hpp"

#include <algorithm>
#include <array>

#include "versine/core/units.hpp"

namespace versine::app {
namespace {

template <class Enum, std::size_t N>
using Words = std::array<std::pair<std::string_view, Enum>, N>;
constexpr Words<track::RailPoint, 2> rail_points{
    {{"gauge-corner", track::RailPoint::gauge_corner}, {"head-centre", track::RailPoint::head_centre}}};
constexpr Words<track::Travel, 2> travels{
    {{"increasing", track::Travel::increasing}, {"decreasing", track::Travel::decreasing}}};
constexpr Words<track::MileageSource, 2> mileages{
    {{"trajectory", track::MileageSource::trajectory}, {"odometer", track::MileageSource::odometer}}};
constexpr Words<track::HeightReference, 2> references{
    {{"low-rail", track::HeightReference::low_rail}, {"axis", track::HeightReference::axis}}};

constexpr KeySpec length(std::string_view doc, double max = 1e6) {
  return {.doc = doc, .unit = "m", .max = max, .positive = true};
}
constexpr KeySpec place(std::string_view doc) {
  return {.doc = doc, .unit = "m", .min = -10, .max = 10};
}
constexpr KeySpec millimetres(std::string_view doc, double min = -1e4, double max = 1e4) {
  return {.doc = doc, .unit = "mm", .scale = units::mm, .min = min, .max = max};
}

void describe_trolley(ConfigVisitor& v, track::Trolley& t) {
  Eigen::Vector3d mounting(t.mounting.roll, t.mounting.pitch, t.mounting.yaw);
  v.value("mounting_deg", mounting,
          {.doc = "Attitude of the IMU in the trolley: roll, pitch, yaw. A survey job takes that of [imu].",
           .unit = "deg",
           .scale = units::deg,
           .min = -360,
           .max = 360});
  t.mounting = {mounting.x(), mounting.y(), mounting.z()};
  Eigen::Vector3d sigma(t.mounting_sigma.roll, t.mounting_sigma.pitch, t.mounting_sigma.yaw);
  v.value("mounting_sigma_deg", sigma,
          {.doc = "What calibration left of it, roll, pitch, yaw; versine calibrate tells.",
           .unit = "deg",
           .scale = units::deg,
           .min = 0,
           .max = 10});
  t.mounting_sigma = {sigma.x(), sigma.y(), sigma.z()};
  v.value("front_x_m", t.front_x, place("Wheel and roller A1 ahead of the IMU, along the trolley."));
  v.value("rear_x_m", t.rear_x, place("Wheel and roller A2."));
  v.value("other_x_m", t.other_x, place("Roller A3 and the gauge sensor's beam."));
  v.value("reference_y_m", t.reference_y,
          place("Contact of A1 and A2 with the reference rail, right of the IMU; negative: it runs on the left."));
  v.value("contact_z_m", t.contact_z, place("Running surface below the IMU."));
  v.value("range_x_m", t.range_x, place("Sleeper sensor."));
  v.value("gauge_offset_mm", t.gauge_offset, millimetres("d1: gauge at reading 0 and 0 deg C."));
  v.value("gauge_temperature_mm_per_degC", t.gauge_temperature_factor,
          {.doc = "K_T: change of the gauge reading's correction with temperature.",
           .unit = "mm/degC",
           .scale = units::mm});
  v.value("gauge_sigma_mm", t.gauge_sigma, millimetres("Of the gauge after averaging, calibration included.", 0));
  v.value("contact_sigma_mm", t.contact_sigma, millimetres("A wheel or roller against the rail: dirt, wear.", 0));
}

void describe_design(ConfigVisitor& v, GeometryConfig& c) {
  v.value(
      "design", c.design,
      {.doc = "Design alignment: LandXML (.xml) or DB TRA (.tra). None: no deviations.", .example = "\"line.xml\""});
  v.value("design_name", c.design_name, {.doc = "Which alignment of the file; empty: the only one."});
  v.value("gradients", c.gradients, {.doc = "DB GRA with the heights of a TRA."});
  v.value("stationing", c.stationing, {.doc = "DB TRA of the stationing line that the GRA refers to."});
  v.value("crs", c.crs,
          {.doc = "CRS of the result; default: the design's, or the UTM zone.", .example = "\"EPSG:25832\""});
  v.value("height_offset_m", c.height_offset, {.doc = "Project height minus ellipsoidal height.", .unit = "m"});
  v.value("height_datum", c.height_datum, {.doc = "Name of the heights' datum, for exports."});
  v.choice<track::HeightReference>("height_reference", c.options.height_reference, references,
                                   {.doc = "What the design's heights belong to where there is cant."});
  v.value("fit_axis", c.fit_axis,
          {.doc = "Without design: fit an optimal axis, refer deviations to it, write axis.xml."});
}

constexpr Words<CoordinatesConfig::Model, 3> models{{{"none", CoordinatesConfig::Model::none},
                                                     {"plane", CoordinatesConfig::Model::plane},
                                                     {"space", CoordinatesConfig::Model::space}}};
constexpr Words<CoordinatesConfig::Heights, 4> height_models{{{"none", CoordinatesConfig::Heights::none},
                                                              {"offset", CoordinatesConfig::Heights::offset},
                                                              {"plane", CoordinatesConfig::Heights::plane},
                                                              {"geoid", CoordinatesConfig::Heights::geoid}}};

void describe_coordinates(ConfigVisitor& v, CoordinatesConfig& c) {
  v.value("points", c.points.file,
          {.doc = "Common points: CSV with name, easting_m, northing_m, height_m (in crs, ellipsoidal), "
                  "project_easting_m, project_northing_m, project_height_m, sigma_mm.",
           .example = "\"common_points.csv\""});
  c.points.description.path = c.points.file.path;
  v.choice<CoordinatesConfig::Model>(
      "similarity", c.model, models,
      {.doc = "To the project's own grid: 4 parameters in the plane, 7 in space, or none."});
  v.value("fixed_scale", c.fixed_scale, {.doc = "Without a scale factor."});
  v.choice<CoordinatesConfig::Heights>(
      "heights", c.heights, height_models,
      {.doc = "To the project's heights: an offset or a tilted plane through the common points, or a geoid."});
  v.value("geoid", c.geoid, {.doc = "Geoid grid, as PROJ finds it.", .example = "\"egm96_15.gtx\""});
}

void describe_mileage(ConfigVisitor& v, GeometryConfig& c) {
  auto& o = c.options;
  v.choice<track::MileageSource>("mileage", o.mileage_source, mileages,
                                 {.doc = "Without design: from the trajectory's or the odometers' way."});
  v.choice<track::Travel>("travel", o.travel, travels,
                          {.doc = "Without design and marks: mileage along the trolley's x axis."});
  v.value("start_mileage_m", o.start_mileage, {.doc = "Without design and marks.", .unit = "m"});
  v.value("max_offset_m", o.max_offset, length("Farther from the design axis a point is off the design."));
  v.tables<GeometryConfig::Mark>(
      "mark", "A place of known mileage, without design.", c.marks, [](ConfigVisitor& t, GeometryConfig::Mark& m) {
        t.value("time_s", m.time_s, {.doc = "When the beam was there.", .unit = "s", .required = true});
        t.value("mileage_m", m.mileage, {.doc = "Its mileage.", .unit = "m", .required = true});
      });
}

void describe_parameters(ConfigVisitor& v, track::GeometryOptions& o) {
  v.value("step_m", o.step, length("Of the result.", 10));
  v.value("fit_half_width_m", o.fit_half_width, length("Half width of the moving least squares of coordinates.", 50));
  v.value("average_window_m", o.average_window,
          length("Window of the moving average of heights, cross level, gauge.", 50));
  v.value("gauge_median_m", o.gauge_median, length("Window of the median filter against rail joints.", 5));
  v.value("max_gap_m", o.max_gap, length("Longer gaps between samples are not bridged.", 100));
  v.choice<track::RailPoint>("rail_point", o.rail_point, rail_points, {.doc = "What a rail's coordinates belong to."});
  v.value("nominal_gauge_mm", o.nominal_gauge, millimetres("Nominal gauge.", 500, 2000));
  v.value("rail_distance_mm", o.rail_distance, millimetres("Hypotenuse of the cross level.", 500, 2200));
  v.value("curvature_base_m", o.curvature_base, length("Chord of curvature and gradient.", 1000));
  v.value("twist_bases_m", o.twist_bases, {.doc = "Bases of twist.", .unit = "m", .positive = true});
  v.value("filter_order", o.filter_order, {.doc = "Order of the low-pass prototype of the bands.", .min = 1, .max = 8});
  v.tables<track::Band>("band", "A wavelength band; without any: D1 and D2.", o.bands,
                        [](ConfigVisitor& t, track::Band& b) {
                          t.value("name", b.name, {.doc = "Part of the columns' names."});
                          t.value("shortest_m", b.shortest, length("Wavelength."));
                          t.value("longest_m", b.longest, length("Wavelength."));
                        });
  v.tables<track::Chord>("chord", "A chord for versines; without any: 10 m and 20 m.", o.chords,
                         [](ConfigVisitor& t, track::Chord& c) {
                           t.value("length_m", c.length, length("Of the chord."));
                           t.value("offset_m", c.offset, length("Of the versine from the chord's start."));
                         });
  v.tables<track::ChordCheck>("check", "A chord check; without any: 30 m / 5 m and 300 m / 150 m.", o.checks,
                              [](ConfigVisitor& t, track::ChordCheck& c) {
                                t.value("name", c.name, {.doc = "Part of the columns' names."});
                                t.value("length_m", c.length, length("Of the chord."));
                                t.value("first_m", c.first, length("First point from the chord's start."));
                                t.value("distance_m", c.distance, length("Between the two points."));
                              });
}

void describe_movement(ConfigVisitor& v, track::AdjustmentOptions& o) {
  v.value("smallest_mm", o.smallest, millimetres("Most negative movement.", -500, 0));
  v.value("largest_mm", o.largest, millimetres("Largest movement.", 0, 500));
  v.value("ramp_mm_per_m", o.ramp,
          {.doc = "Steepest change of movement.", .unit = "mm/m", .scale = 1e-3, .positive = true});
  v.value("run_in_m", o.run_in, {.doc = "Run-in and run-out.", .unit = "m", .min = 0});
  v.value("design_weight", o.design_weight, {.doc = "A metre left from design against a metre moved.", .min = 0});
  v.value("smooth_weight", o.smooth_weight, {.doc = "A bend left against a metre moved.", .min = 0});
  v.tables<track::AdjustmentOptions::Fixed>(
      "fixed", "A stretch that must not move.", o.fixed, [](ConfigVisitor& t, track::AdjustmentOptions::Fixed& f) {
        t.value("from_m", f.from, {.doc = "Distance along the axis.", .unit = "m"});
        t.value("to_m", f.to, {.doc = "Distance along the axis.", .unit = "m"});
      });
}

void describe_adjustment(ConfigVisitor& v, GeometryConfig& c) {
  v.value("on", c.adjust, {.doc = "Plan slews and lifts that bring the chord checks within their limits."});
  v.value("spacing_m", c.slew.spacing, length("Between the points that are solved for."));
  c.lift.spacing = c.slew.spacing;
  v.table("slew", "Lateral movement, positive right.", [&](ConfigVisitor& t) { describe_movement(t, c.slew); });
  v.table("lift", "Vertical movement.", [&](ConfigVisitor& t) { describe_movement(t, c.lift); });
  v.value("columns", c.table.columns, {.doc = "Of adjustment.csv, in order."});
  v.value("slew_right_positive", c.table.slew_right_positive, {.doc = "Sign of the slew in adjustment.csv."});
  v.value("interval_m", c.table.interval, length("Between rows of adjustment.csv."));
  v.value("delimiter", c.table.delimiter, {.doc = "Of adjustment.csv."});
  v.value("decimal_comma", c.table.decimal_comma, {.doc = "Instead of a point."});
}

void describe_shims(ConfigVisitor& v, track::FasteningOptions& o) {
  v.value("step_mm", o.step, {.doc = "Of shims or wedges.", .unit = "mm", .scale = units::mm, .positive = true});
  v.value("lowest_mm", o.lowest, millimetres("Most negative movement of a fastening.", -100, 0));
  v.value("highest_mm", o.highest, millimetres("Largest movement.", 0, 100));
  v.value("deviation_limit_mm", o.deviation_limit, millimetres("Left from design, at most.", 0));
  v.value("difference_limit_mm", o.difference_limit, millimetres("Left of gauge or cross level, at most.", 0));
  v.value("neighbour_limit_mm", o.neighbour_limit, millimetres("Between movements of neighbours, at most.", 0));
  v.value("check_limits_mm", o.check_limits,
          {.doc = "Of each check: 30 m chord, 5 m apart.", .unit = "mm", .scale = units::mm, .positive = true});
}

void describe_fastenings(ConfigVisitor& v, FasteningConfig& c) {
  constexpr Words<FasteningConfig::Reference, 2> rails{
      {{"left", FasteningConfig::Reference::left}, {"right", FasteningConfig::Reference::right}}};
  v.value("on", c.on, {.doc = "Plan the fine adjustment of a slab track: fewest fastenings, whole shims."});
  v.value("spacing_m", c.spacing, length("Of fastenings, where no sleepers were detected.", 10));
  v.choice<FasteningConfig::Reference>("reference", c.reference, rails, {.doc = "Rail that is adjusted first."});
  v.table("lateral", "Movement across, positive right.", [&](ConfigVisitor& t) { describe_shims(t, c.lateral); });
  v.table("vertical", "Movement of height.", [&](ConfigVisitor& t) { describe_shims(t, c.vertical); });
}

}  // namespace

void describe(ConfigVisitor& v, GeometryConfig& c) {
  describe_design(v, c);
  describe_mileage(v, c);
  v.table("coordinates", "To a grid and heights of the project's own.",
          [&](ConfigVisitor& t) { describe_coordinates(t, c.coordinates); });
  v.value("error_correlation_m", c.error_correlation,
          {.doc = "For trajectories without joint errors: over this way the trajectory's errors change. 0: versines, "
                  "checks, bands and twist have no sigma then.",
           .unit = "m",
           .min = 0});
  describe_parameters(v, c.options);
  v.table("trolley", "Wheels, rollers and gauge sensor.", [&](ConfigVisitor& t) { describe_trolley(t, c.trolley); });
  v.table("gauge", "The gauge sensor's file.", [&](ConfigVisitor& t) { describe(t, c.gauge); });
  v.table("sleeper", "The sleeper sensor's file: range to the ground.",
          [&](ConfigVisitor& t) { describe(t, c.sleeper); });
  v.table("quality", "Limits.", [&](ConfigVisitor& t) {
    t.value("limits", c.limits, {.doc = "File of limits; none: no assessment.", .example = "\"en13848-5.toml\""});
    t.value("speed_kmh", c.speed, {.doc = "Speed of the line.", .unit = "km/h", .scale = units::kmh, .positive = true});
  });
  v.table("adjustment", "Lining and lifting.", [&](ConfigVisitor& t) { describe_adjustment(t, c); });
  v.table("fastenings", "Fine adjustment of a slab track.",
          [&](ConfigVisitor& t) { describe_fastenings(t, c.fastenings); });
  v.table("write", "Files of the result.", [&](ConfigVisitor& t) {
    t.value("csv", c.csv, {.doc = "geometry.csv and its companions."});
    t.value("gpkg", c.gpkg, {.doc = "result.gpkg."});
    t.value("xlsx", c.xlsx, {.doc = "geometry.xlsx."});
    t.value("dxf", c.dxf, {.doc = "geometry.dxf."});
    t.value("gis_interval_m", c.gis_interval, length("Between points of result.gpkg and geometry.dxf."));
    t.value("xlsx_interval_m", c.xlsx_interval, length("Between rows of geometry.xlsx."));
  });
}

void describe(ConfigVisitor& v, track::LimitProfile& p) {
  v.value("name", p.name, {.doc = "Of the profile.", .required = true});
  v.value("source", p.source,
          {.doc = "Where its numbers come from; [M]: not read in the standard itself.", .required = true});
  v.value("levels", p.levels, {.doc = "Levels in order of severity."});
  v.value("section_m", p.section, length("Of the statistics."));
  v.value("tqi_columns", p.tqi_columns,
          {.doc = "Columns whose standard deviations add up to the TQI; 'twist_3m*3' takes three metres of twist."});
  v.value("cosd_weights", p.cosd_weights,
          {.doc = "Of alignment, gauge, cross level, level in the combined standard deviation."});
  v.tables<track::SpeedClass>(
      "speed", "What is allowed up to a speed.", p.speeds, [](ConfigVisitor& s, track::SpeedClass& c) {
        s.value("max_kmh", c.speed, {.doc = "Inclusive.", .unit = "km/h", .scale = units::kmh, .required = true});
        s.value("tqi_mm", c.tqi, {.doc = "Management value of the TQI; 0: none.", .unit = "mm", .min = 0});
        s.tables<track::Limit>("limit", "Of one value.", c.limits, [](ConfigVisitor& t, track::Limit& l) {
          t.value("column", l.column, {.doc = "Name; '*' stands for any part.", .required = true});
          t.value("level", l.level, {.doc = "One of levels.", .required = true});
          t.value("low", l.low, {.doc = "Exceeded below.", .unit = "mm or mm/m", .scale = 1e-3, .required = true});
          t.value("high", l.high, {.doc = "Exceeded above.", .unit = "mm or mm/m", .scale = 1e-3, .required = true});
          t.value("source", l.source, {.doc = "Of this number, where it differs."});
        });
        s.tables<track::SectionLimit>(
            "sigma", "Of a standard deviation.", c.section_limits, [](ConfigVisitor& t, track::SectionLimit& l) {
              t.value("column", l.column, {.doc = "Name.", .required = true});
              t.value("level", l.level, {.doc = "One of levels.", .required = true});
              t.value("max", l.sigma,
                      {.doc = "Exceeded above.", .unit = "mm or mm/m", .scale = 1e-3, .required = true});
              t.value("source", l.source, {.doc = "Of this number, where it differs."});
            });
        s.tables<track::QualityClasses>(
            "classes", "Quality classes by standard deviation.", c.classes,
            [](ConfigVisitor& t, track::QualityClasses& q) {
              t.value("column", q.column, {.doc = "Name.", .required = true});
              t.value("names", q.names, {.doc = "Best first; one more than bounds.", .required = true});
              t.value("bounds", q.bounds, {.doc = "Upper bounds.", .unit = "mm", .scale = 1e-3, .required = true});
              t.value("source", q.source, {.doc = "Of these numbers, where it differs."});
            });
      });
}

Expected<track::LimitProfile> read_limits(const std::filesystem::path& path) {
  track::LimitProfile p;
  if (auto done = read_config(path, [&](ConfigVisitor& v) { describe(v, p); }); !done)
    return tl::unexpected(done.error());
  for (auto& s : p.speeds) s.tqi *= 1e-3;
  const auto known = [&](const std::string& level) {
    return std::find(p.levels.begin(), p.levels.end(), level) != p.levels.end();
  };
  for (const auto& s : p.speeds) {
    for (const auto& l : s.limits) {
      if (known(l.level) && l.low < l.high) continue;
      return fail({.file = path.string(),
                   .field = "limit of " + l.column,
                   .found = "level '" + l.level + "'",
                   .expected = "one of levels, and low below high"});
    }
    for (const auto& q : s.classes) {
      if (q.names.size() == q.bounds.size() + 1 && std::is_sorted(q.bounds.begin(), q.bounds.end())) continue;
      return fail({.file = path.string(),
                   .field = "classes of " + q.column,
                   .found = "names that do not match the bounds",
                   .expected = "increasing bounds and one name more"});
    }
  }
  std::sort(p.speeds.begin(), p.speeds.end(), [](const auto& a, const auto& b) { return a.speed < b.speed; });
  return p;
}

}  // namespace versine::app
