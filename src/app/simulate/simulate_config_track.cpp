// SPDX-License-Identifier: Apache-2.0
// Keys of the line, of the body on it and of its motion.
#include "simulate_config_parts.hpp"

namespace versine::app::scenario {

namespace {
constexpr Words<design::Shape, 9> shapes{{{"line", design::Shape::line},
                                          {"arc", design::Shape::arc},
                                          {"clothoid", design::Shape::clothoid},
                                          {"helmert", design::Shape::helmert},
                                          {"bloss", design::Shape::bloss},
                                          {"cosine", design::Shape::cosine},
                                          {"sine", design::Shape::sine},
                                          {"viennese", design::Shape::viennese},
                                          {"cubic-parabola", design::Shape::cubic_parabola}}};
constexpr Words<ElementConfig::Turn, 2> turns{
    {{"right", ElementConfig::Turn::right}, {"left", ElementConfig::Turn::left}}};
using Curve = design::VerticalPoint::Curve;
constexpr Words<Curve, 3> curves{{{"none", Curve::none}, {"parabola", Curve::parabola}, {"circle", Curve::circle}}};
using Pivot = sim::TrackModel::CantPivot;
constexpr Words<Pivot, 2> pivots{{{"axis", Pivot::axis}, {"low-rail", Pivot::low_rail}}};
using Kind = sim::Defect::Kind;
constexpr Words<Kind, 6> defects{{{"dip", Kind::dip},
                                  {"bump", Kind::bump},
                                  {"kink", Kind::kink},
                                  {"twist", Kind::twist},
                                  {"gauge", Kind::gauge},
                                  {"wave", Kind::wave}}};
using Side = sim::Defect::Rail;
constexpr Words<Side, 3> sides{{{"left", Side::left}, {"right", Side::right}, {"both", Side::both}}};

void describe_line(ConfigVisitor& v, SimulateConfig& c) {
  v.value("alignment_file", c.alignment_file,
          {.doc = "LandXML or DB TRA file with the design, instead of the elements below.", .example = "\"line.xml\""});
  v.value("alignment_name", c.alignment_name, {.doc = "Which alignment of that file, when it holds several."});
  v.value("gradients_file", c.gradients_file, {.doc = "DB GRA file of a TRA."});
  v.value("stationing_file", c.stationing_file, {.doc = "TRA file of the stationing line of a GRA."});
  v.value("crs", c.crs, {.doc = "Map of the alignment's coordinates.", .example = "\"EPSG:25832\""});
  v.value("easting_m", c.easting, metres("Start of the elements."));
  v.value("northing_m", c.northing, metres("Start of the elements."));
  v.value("heading_deg", c.heading,
          {.doc = "Direction at the start, from grid north clockwise.",
           .unit = "deg",
           .scale = units::deg,
           .min = -360,
           .max = 360});
  v.value("mileage_m", c.mileage, metres("Of the start, as the railway counts it."));
  v.tables<ElementConfig>(
      "horizontal", "Element of the horizontal alignment, each beginning where the last one ends.", c.horizontal,
      [](ConfigVisitor& t, ElementConfig& e) {
        t.choice<design::Shape>("type", e.shape, shapes, {.doc = "Line, arc or a transition."});
        t.value("length_m", e.length,
                {.doc = "Along the axis.", .unit = "m", .positive = true, .required = true, .example = "100.0"});
        t.value("radius_m", e.radius,
                {.doc = "Of an arc; 'turn' says which way.", .unit = "m", .max = 1e6, .positive = true});
        t.choice<ElementConfig::Turn>("turn", e.turn, turns, {.doc = "Which way a curve goes."});
        t.value("start_radius_m", e.radius_start,
                {.doc = "Of a transition; 0: straight; default: that of the element before.",
                 .unit = "m",
                 .min = 0,
                 .max = 1e6});
        t.value("end_radius_m", e.radius_end,
                {.doc = "Of a transition; 0: straight; default: that of the element behind.",
                 .unit = "m",
                 .min = 0,
                 .max = 1e6});
      });
  v.tables<design::VerticalPoint>("vertical", "Point where two gradients meet.", c.vertical,
                                  [](ConfigVisitor& t, design::VerticalPoint& p) {
                                    t.value("distance_m", p.distance, metres("Along the axis."));
                                    t.value("height_m", p.height, metres("Ellipsoidal, of the intersection."));
                                    t.choice<Curve>("curve", p.curve, curves, {.doc = "What rounds it."});
                                    t.value("radius_m", p.radius, metres("Of that curve.", 0.0));
                                  });
  v.tables<design::CantPoint>(
      "cant", "Cant at a distance; ramps lead from one to the next.", c.cant,
      [](ConfigVisitor& t, design::CantPoint& p) {
        t.value("distance_m", p.distance, metres("Along the axis."));
        t.value("cant_mm", p.cant, millimetres("Over 1500 mm; positive when the left rail is higher.", -1e4));
        t.choice<design::Shape>("ramp", p.ramp, shapes,
                                {.doc = "Towards the next point; clothoid is a straight ramp."});
      });
  v.tables<design::ChainageEquation>("chainage", "Where mileage jumps.", c.chainage,
                                     [](ConfigVisitor& t, design::ChainageEquation& e) {
                                       t.value("distance_m", e.distance, metres("Along the axis."));
                                       t.value("mileage_m", e.mileage, metres("From here on."));
                                     });
}
}  // namespace

void describe_euler(ConfigVisitor& v, std::string_view key, geodesy::Euler& e, std::string_view doc) {
  Eigen::Vector3d angles(e.roll, e.pitch, e.yaw);
  v.value(key, angles, {.doc = doc, .unit = "deg", .scale = units::deg, .min = -360, .max = 360});
  e = {angles.x(), angles.y(), angles.z()};
}

void describe_track(ConfigVisitor& v, SimulateConfig& c) {
  sim::TrackModel& track = c.scenario.track;
  describe_line(v, c);
  v.value("height_m", track.height, metres("Ellipsoidal, for a line without vertical points."));
  v.choice<Pivot>("cant_pivot", track.cant_pivot, pivots, {.doc = "What keeps the design height where there is cant."});
  v.value("gauge_mm", track.gauge, {.doc = "Nominal.", .unit = "mm", .scale = units::mm, .min = 300, .max = 2000});
  v.value("grid_m", track.grid,
          {.doc = "Between the points at which the rails are computed.", .unit = "m", .max = 1, .positive = true});
  v.choice<sim::Spectrum>("spectrum", track.spectrum, sim::spectrum_names(),
                          {.doc = "Power spectral density of the irregularities."});
  v.value("spectrum_factor", track.spectrum_factor, count_of("Of its amplitudes.", ""));
  v.value("shortest_m", track.shortest, {.doc = "Wavelength of the spectrum.", .unit = "m", .positive = true});
  v.value("longest_m", track.longest, {.doc = "Wavelength of the spectrum.", .unit = "m", .positive = true});
  double seed = static_cast<double>(track.seed);
  v.value("seed", seed, {.doc = "Of the irregularities; the runs of a set share one track.", .min = 0, .max = 9e15});
  track.seed = static_cast<std::uint64_t>(seed);
  v.tables<sim::Defect>(
      "defect", "A single defect on top of the spectrum.", track.defects, [](ConfigVisitor& t, sim::Defect& d) {
        t.choice<Kind>("kind", d.kind, defects, {.doc = "What it is."});
        t.choice<Side>("rail", d.rail, sides, {.doc = "Which rail a dip, bump or wave is in."});
        t.value("distance_m", d.distance, metres("Its centre, along the axis."));
        t.value("amplitude_mm", d.amplitude, millimetres("Its size; dips go down.", -1e4));
        t.value("length_m", d.length,
                {.doc = "Of the defect, or the wavelength of a wave.", .unit = "m", .positive = true});
        t.value("extent_m", d.extent, metres("Of a wave.", 0.0));
      });
  v.value("table_file", c.table_file,
          {.doc = "CSV with distance_m and any of level_mm, alignment_mm, cross_level_mm, gauge_mm (deviations), at a "
                  "fixed step; added to all else."});
  v.value("sleeper_spacing_m", track.sleeper_spacing, metres("Between sleepers.", 0.0));
  v.value("sleeper_jitter_m", track.sleeper_jitter, metres("Sigma of a sleeper's place.", 0.0));
  v.value("sleepers_m", track.sleepers, {.doc = "Their distances, instead of a spacing.", .unit = "m"});
}

void describe_body(ConfigVisitor& v, SimulateConfig& c) {
  v.table("trolley", "The measuring trolley, in its frame: origin in the IMU, x forward, y right, z down.",
          [&](ConfigVisitor& t) {
            track::Trolley& b = c.scenario.trolley;
            describe_euler(t, "mounting_deg", b.mounting, "Roll, pitch, yaw of the IMU in the trolley.");
            t.value("front_x_m", b.front_x, metres("Wheel A1."));
            t.value("rear_x_m", b.rear_x, metres("Wheel A2."));
            t.value("other_x_m", b.other_x, metres("Wheel A3 and the gauge sensor's beam."));
            t.value("reference_y_m", b.reference_y, metres("A1 and A2; negative: they run on the trolley's left."));
            t.value("contact_z_m", b.contact_z, metres("Running surface below the IMU."));
            t.value("range_x_m", b.range_x, metres("Sleeper sensor."));
            t.value("gauge_offset_mm", b.gauge_offset, millimetres("Gauge at reading 0 and 0 deg C."));
            t.value("gauge_temperature_mm_per_degc", b.gauge_temperature_factor,
                    {.doc = "Change of the reading with temperature.", .unit = "mm/deg C", .scale = units::mm});
          });
  v.table(
      "vehicle", "An in-service vehicle instead of the trolley.",
      [&](ConfigVisitor& t) {
        t.value("bogie_distance_m", c.vehicle.bogie_distance,
                {.doc = "Between the bogies' centres.", .unit = "m", .max = 40, .positive = true});
        t.value("axle_distance_m", c.vehicle.axle_distance, metres("Within a bogie.", 0.0));
        t.value("imu_m", c.vehicle.imu, metres("IMU from the middle of the vehicle at the running surface."));
        describe_euler(t, "mounting_deg", c.vehicle.mounting, "Roll, pitch, yaw of the IMU in the vehicle.");
      },
      &c.has_vehicle);
}

void describe_motion(ConfigVisitor& t, sim::Motion& m) {
  t.value("start_m", m.start, metres("Along the axis."));
  t.value("facing_back", m.facing_back, {.doc = "The body faces decreasing distance."});
  t.value("stand_s", m.stand, seconds("Before the first leg, for the initial alignment."));
  t.value("unevenness", m.unevenness,
          {.doc = "Relative sigma of the speed: 0.1 is a person who pushes.", .min = 0, .max = 0.15});
  t.value("unevenness_period_s", m.unevenness_period, {.doc = "Its typical period.", .unit = "s", .positive = true});
  t.tables<sim::Leg>("leg", "To a place at a speed, then a stop. Going back is a leg to a smaller distance.", m.legs,
                     [](ConfigVisitor& l, sim::Leg& leg) {
                       l.value("to_m", leg.to, metres("Along the axis."));
                       l.value("speed_kmh", leg.speed,
                               {.doc = "Between stops.", .unit = "km/h", .scale = units::kmh, .max = 400});
                       l.value("acceleration_mps2", leg.acceleration,
                               {.doc = "Largest, also for braking.", .unit = "m/s^2", .max = 10});
                       l.value("stop_s", leg.stop, seconds("Standing at the end."));
                       l.value("stop_every_m", leg.stop_every, metres("Stops on the way, this far apart; 0: none.", 0));
                       l.value("stop_each_s", leg.stop_each, seconds("Their length."));
                     });
}

}  // namespace versine::app::scenario
