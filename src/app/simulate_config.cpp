// SPDX-License-Identifier: Apache-2.0
#include "versine/app/simulate_config.hpp"

#include <array>

#include "versine/core/units.hpp"

namespace versine::app {

namespace {
namespace sim = simulation;
template <class Enum, std::size_t N>
using Words = std::array<std::pair<std::string_view, Enum>, N>;

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

constexpr KeySpec metres(std::string_view doc, double min = -1e9) {
  return {.doc = doc, .unit = "m", .min = min};
}
constexpr KeySpec millimetres(std::string_view doc, double min = 0.0) {
  return {.doc = doc, .unit = "mm", .scale = units::mm, .min = min};
}
constexpr KeySpec seconds(std::string_view doc) {
  return {.doc = doc, .unit = "s", .min = 0};
}
constexpr KeySpec share(std::string_view doc) {
  return {.doc = doc, .min = 0, .max = 1};
}
constexpr KeySpec rate(std::string_view doc, double max) {
  return {.doc = doc, .unit = "Hz", .max = max, .positive = true};
}
constexpr KeySpec count_of(std::string_view doc, std::string_view unit) {
  return {.doc = doc, .unit = unit, .min = 0};
}

void describe_euler(ConfigVisitor& v, std::string_view key, geodesy::Euler& e, std::string_view doc) {
  Eigen::Vector3d angles(e.roll, e.pitch, e.yaw);
  v.value(key, angles, {.doc = doc, .unit = "deg", .scale = units::deg, .min = -360, .max = 360});
  e = {angles.x(), angles.y(), angles.z()};
}

void describe_stretch(ConfigVisitor& v, sim::Stretch& s, bool time) {
  v.value(time ? "from_s" : "from_m", s.from, {.doc = "Beginning.", .unit = time ? "s" : "m"});
  v.value(time ? "to_s" : "to_m", s.to, {.doc = "End.", .unit = time ? "s" : "m"});
}

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
  v.table("motion", "How it moves.", [&](ConfigVisitor& t) {
    sim::Motion& m = c.scenario.motion;
    t.value("start_m", m.start, metres("Along the axis."));
    t.value("facing_back", m.facing_back, {.doc = "The body faces decreasing distance."});
    t.value("stand_s", m.stand, seconds("Before the first leg, for the initial alignment."));
    t.value("unevenness", m.unevenness,
            {.doc = "Relative sigma of the speed: 0.1 is a person who pushes.", .min = 0, .max = 0.15});
    t.value("unevenness_period_s", m.unevenness_period, {.doc = "Its typical period.", .unit = "s", .positive = true});
    t.tables<sim::Leg>(
        "leg", "To a place at a speed, then a stop. Going back is a leg to a smaller distance.", m.legs,
        [](ConfigVisitor& l, sim::Leg& leg) {
          l.value("to_m", leg.to, metres("Along the axis."));
          l.value("speed_kmh", leg.speed, {.doc = "Between stops.", .unit = "km/h", .scale = units::kmh, .max = 400});
          l.value("acceleration_mps2", leg.acceleration,
                  {.doc = "Largest, also for braking.", .unit = "m/s^2", .max = 10});
          l.value("stop_s", leg.stop, seconds("Standing at the end."));
          l.value("stop_every_m", leg.stop_every, metres("Stops on the way, this far apart; 0: none.", 0));
          l.value("stop_each_s", leg.stop_each, seconds("Their length."));
        });
  });
}

void describe_imu(ConfigVisitor& v, SimulateConfig& c) {
  sim::ImuModel& m = c.imu;
  describe(v, c.imu_errors);
  v.value("rate_hz", m.rate, rate("Of the samples.", 4000));
  v.value("rates", c.write_rates, {.doc = "Write mean rates instead of increments."});
  using Instability = sim::ImuModel::Instability;
  static constexpr Words<Instability, 2> kinds{
      {{"gauss-markov", Instability::gauss_markov}, {"flicker", Instability::flicker}}};
  v.choice<Instability>("instability", m.instability, kinds, {.doc = "How the bias instability varies."});
  v.value("gyro_bias_degph", m.gyro_bias,
          {.doc = "The constant bias itself, instead of its sigma.", .unit = "deg/h", .scale = units::deg_per_hour});
  v.value("accelerometer_bias_mgal", m.accelerometer_bias,
          {.doc = "The constant bias itself.", .unit = "mGal", .scale = units::mGal});
  v.value("gyro_scale_ppm", m.gyro_scale, {.doc = "The scale errors themselves.", .unit = "ppm", .scale = units::ppm});
  v.value("accelerometer_scale_ppm", m.accelerometer_scale,
          {.doc = "The scale errors themselves.", .unit = "ppm", .scale = units::ppm});
  v.value("gyro_temperature_degph_per_degc", m.gyro_temperature_factor,
          {.doc = "Bias per degree away from 20 deg C.", .unit = "deg/h/deg C", .scale = units::deg_per_hour});
  v.value("accelerometer_temperature_mgal_per_degc", m.accelerometer_temperature_factor,
          {.doc = "Bias per degree away from 20 deg C.", .unit = "mGal/deg C", .scale = units::mGal});
  v.value("gyro_quantum_arcsec", m.gyro_quantum,
          {.doc = "Step of the angle counters; 0: none.", .unit = "arcsec", .scale = units::arcsec, .min = 0});
  v.value("accelerometer_quantum_mps", m.accelerometer_quantum,
          {.doc = "Step of the velocity counters; 0: none.", .unit = "m/s", .min = 0});
  v.value("clock_jitter_us", m.clock_jitter, {.doc = "Sigma of each stamp.", .unit = "us", .scale = 1e-6, .min = 0});
  v.value("clock_drift_ppm", m.clock_drift, {.doc = "Stamps run fast by this.", .unit = "ppm", .scale = units::ppm});
  v.value("vibration_gyro_degpsqrth", m.vibration_gyro,
          {.doc = "Random walk added for each m/s of speed.",
           .unit = "deg/sqrt(h) / (m/s)",
           .scale = units::deg_per_sqrt_hour,
           .min = 0});
  v.value("vibration_accelerometer_mpspsqrth", m.vibration_accelerometer,
          {.doc = "Random walk added for each m/s of speed.",
           .unit = "m/s/sqrt(h) / (m/s)",
           .scale = units::mps_per_sqrt_hour,
           .min = 0});
}

void describe_odometer(ConfigVisitor& v, sim::OdometerModel& m) {
  using Wheel = sim::OdometerModel::Wheel;
  using Output = sim::OdometerModel::Output;
  static constexpr Words<Wheel, 2> wheels{{{"a1", Wheel::a1}, {"a3", Wheel::a3}}};
  static constexpr Words<Output, 2> outputs{{{"distance", Output::distance}, {"pulses", Output::pulses}}};
  v.choice<Wheel>("wheel", m.wheel, wheels, {.doc = "A1 on the reference rail, or A3 on the other."});
  v.choice<Output>("output", m.output, outputs, {.doc = "Samples at a fixed rate, or one a pulse."});
  v.value("rate_hz", m.rate, rate("Of distances.", 2000));
  v.value("count_mm", m.quantum, millimetres("Distance of one count; 0: not counted."));
  v.value("scale_ppm", m.scale, {.doc = "Sigma of the scale error.", .unit = "ppm", .scale = units::ppm, .min = 0});
  v.value("scale_value_ppm", m.scale_value, {.doc = "The scale error itself.", .unit = "ppm", .scale = units::ppm});
  v.value("scale_walk_ppm_per_sqrtm", m.scale_walk,
          {.doc = "Random walk of the scale.", .unit = "ppm/sqrt(m)", .scale = units::ppm, .min = 0});
  v.value("slip_per_km", m.slip_per_km, count_of("Slip and slide events.", "1/km"));
  v.value("slip_distance_m", m.slip_distance, metres("Sigma of the distance gained or lost in one.", 0));
}

void describe_gauge(ConfigVisitor& v, sim::GaugeModel& m) {
  v.value("rate_hz", m.rate, rate("Of the samples.", 2000));
  v.value("noise_mm", m.noise, millimetres("Sigma of a reading."));
  v.value("offset_error_mm", m.offset_error, millimetres("Sigma of the calibration's error."));
  v.value("joint_spacing_m", m.joint_spacing, metres("Between welds; 0: none.", 0));
  v.value("joint_spike_mm", m.joint_spike, millimetres("Sigma of the spike at a weld."));
}

void describe_sleeper(ConfigVisitor& v, sim::SleeperModel& m) {
  v.value("rate_hz", m.rate, rate("Of the samples.", 2000));
  v.value("range_m", m.range, metres("From the sensor to ballast or slab.", 0));
  v.value("sleeper_height_m", m.height, metres("Of a sleeper above that.", 0));
  v.value("sleeper_width_m", m.width, metres("Along the track.", 0));
  v.value("noise_m", m.noise, metres("Sigma of a reading.", 0));
  v.value("missed", m.missed, share("Probability that a sleeper is not seen."));
  v.value("false_per_km", m.false_per_km, count_of("Things taken for a sleeper.", "1/km"));
}

void describe_gnss(ConfigVisitor& v, sim::GnssModel& m) {
  v.value("rate_hz", m.rate, rate("Of the epochs.", 100));
  v.value("antenna_m", m.antenna, metres("From the IMU: forward, right, down."));
  v.value("velocity", m.velocity, {.doc = "The receiver gives velocities."});
  v.value("sigma_horizontal_m", m.sigma_horizontal, metres("White part with fixed ambiguities.", 0));
  v.value("sigma_vertical_m", m.sigma_vertical, metres("White part with fixed ambiguities.", 0));
  v.value("correlated_horizontal_m", m.correlated_horizontal, metres("Correlated part.", 0));
  v.value("correlated_vertical_m", m.correlated_vertical, metres("Correlated part.", 0));
  v.value("correlation_time_s", m.correlation_time, {.doc = "Of that part.", .unit = "s", .positive = true});
  v.value("sigma_velocity_mps", m.sigma_velocity, count_of("Of each component.", "m/s"));
  v.value("float_factor", m.float_factor, count_of("Errors grow by this while ambiguities are float.", ""));
  v.value("refix_time_s", m.refix_time, {.doc = "Float after an outage, mean.", .unit = "s", .positive = true});
  v.value("single_factor", m.single_factor, count_of("Errors grow by this while there is no correction.", ""));
  v.value("single_per_h", m.single_per_h, count_of("Episodes without correction.", "1/h"));
  v.value("single_time_s", m.single_time, {.doc = "Their mean length.", .unit = "s", .positive = true});
  v.value("multipath_per_h", m.multipath_per_h, count_of("Episodes of multipath.", "1/h"));
  v.value("multipath_time_s", m.multipath_time, {.doc = "Their mean length.", .unit = "s", .positive = true});
  v.value("multipath_sigma_m", m.multipath_sigma, metres("Of their size, each axis.", 0));
  v.value("wrong_fix_per_h", m.wrong_fix_per_h, count_of("Wrong ambiguities, told as fixed.", "1/h"));
  v.value("wrong_fix_time_s", m.wrong_fix_time, {.doc = "Their mean length.", .unit = "s", .positive = true});
  v.value("wrong_fix_smallest_m", m.wrong_fix_smallest, metres("Their size.", 0));
  v.value("wrong_fix_largest_m", m.wrong_fix_largest, metres("Their size.", 0));
  v.value("lying_fix", m.lying_fix, share("Probability that an epoch that is not fixed is told as fixed."));
  v.value("optimism", m.sigma_factor, {.doc = "True sigma over the receiver's own.", .positive = true});
  v.tables<sim::Stretch>("outage", "Tunnel or bridge: no positions between two distances.", m.outages,
                         [](ConfigVisitor& t, sim::Stretch& s) { describe_stretch(t, s, false); });
}

void describe_total_station(ConfigVisitor& v, sim::TotalStationModel& m) {
  using Output = sim::TotalStationModel::Output;
  static constexpr Words<Output, 3> outputs{
      {{"positions", Output::positions}, {"readings", Output::readings}, {"both", Output::both}}};
  v.choice<Output>("output", m.output, outputs, {.doc = "Positions of stationings, raw readings, or both."});
  v.value("every_m", m.every, metres("Between stationings; each needs a stop.", 0));
  v.value("shortest_stop_s", m.shortest_stop, seconds("A shorter stop has no stationing."));
  v.value("place_m", m.place, metres("Instrument's centre or prism from the IMU: forward, right, down."));
  describe_euler(v, "mounting_deg", m.mounting, "Roll, pitch, yaw of the instrument in the trolley.");
  v.value("sigma_position_mm", m.sigma_position, millimetres("Of a position, each axis."));
  v.value("blunder", m.blunder, share("Probability that a position is wrong."));
  v.value("blunder_mm", m.blunder_size, millimetres("By how much."));
  v.value("pair_spacing_m", m.pair_spacing, {.doc = "Between pairs of control points.", .unit = "m", .positive = true});
  v.value("point_side_m", m.point_side, metres("Control points beside the axis.", 0));
  v.value("point_height_m", m.point_height, metres("And above the rails."));
  v.value("sigma_point_mm", m.sigma_point, millimetres("Of their coordinates."));
  v.value("targets", m.targets, {.doc = "Points sighted from one place.", .min = 2, .max = 50});
  v.value("sigma_angle_arcsec", m.sigma_angle,
          {.doc = "Of directions and zenith angles.", .unit = "arcsec", .scale = units::arcsec, .min = 0});
  v.value("sigma_distance_mm", m.sigma_distance, millimetres("Of distances."));
  v.value("sigma_distance_ppm", m.sigma_distance_ppm,
          {.doc = "Of distances.", .unit = "ppm", .scale = units::ppm, .min = 0});
  v.value("refraction", m.refraction, {.doc = "Coefficient k of the light's bending.", .min = -5, .max = 5});
  v.value("sighting_blunder", m.sighting_blunder, share("Probability that a sighting is wrong."));
  v.value("sighting_blunder_mm", m.sighting_blunder_size, millimetres("By how much."));
}

void describe_axle_box(ConfigVisitor& v, sim::AxleBoxModel& m) {
  v.value("rate_hz", m.rate, rate("Of the samples.", 100000));
  v.value("roughness_mps2", m.roughness, count_of("Sigma at 1 m/s; grows with the speed.", "m/s^2"));
  v.value("joints_m", m.joints, {.doc = "Distances of rail joints.", .unit = "m"});
  v.value("switches_m", m.switches, {.doc = "Distances of crossing noses.", .unit = "m"});
  v.value("joint_mps2", m.joint_impact, count_of("Blow at 1 m/s.", "m/s^2"));
  v.value("switch_mps2", m.switch_impact, count_of("Blow at 1 m/s.", "m/s^2"));
  v.table("recorded", "Part of the recording; default: all.",
          [&](ConfigVisitor& t) { describe_stretch(t, m.recorded, true); });
}

void describe_fault(ConfigVisitor& v, sim::Fault& f) {
  using FaultKind = sim::Fault::Kind;
  using Sensor = sim::Fault::Sensor;
  static constexpr Words<FaultKind, 8> kinds{{{"gap", FaultKind::gap},
                                              {"duplicate", FaultKind::duplicate},
                                              {"reorder", FaultKind::reorder},
                                              {"stuck", FaultKind::stuck},
                                              {"delay", FaultKind::delay},
                                              {"nan", FaultKind::not_a_number},
                                              {"clock-step", FaultKind::clock_step},
                                              {"spike", FaultKind::spike}}};
  static constexpr Words<Sensor, 5> sensors{{{"imu", Sensor::imu},
                                             {"odometer", Sensor::odometer},
                                             {"gauge", Sensor::gauge},
                                             {"sleeper", Sensor::sleeper},
                                             {"gnss", Sensor::gnss}}};
  v.choice<FaultKind>("kind", f.kind, kinds, {.doc = "What goes wrong."});
  v.choice<Sensor>("sensor", f.sensor, sensors, {.doc = "Where."});
  v.value("at_s", f.at, seconds("Since the start."));
  v.value("duration_s", f.duration, seconds("How long."));
  v.value("amount", f.amount, {.doc = "Seconds of a clock step or a batch; size of a spike in SI units."});
}
}  // namespace

void describe(ConfigVisitor& v, SimulateConfig& c) {
  v.value("job", c.job, {.doc = "Kind of this job.", .required = true, .example = "\"simulate\""});
  v.value("title", c.title, {.doc = "What is simulated."});
  v.value("seed", c.seed, {.doc = "Of the sensors' errors.", .min = 0, .max = 9e15});
  v.value("runs", c.runs, {.doc = "Recordings with the same truth and other errors.", .min = 1, .max = 1000000});
  v.value("start_gps_s", c.start_gps_s, {.doc = "GPS time of the start.", .unit = "s", .min = 0, .max = 4e9});
  v.table("track", "The line and how it lies.", [&](ConfigVisitor& t) { describe_track(t, c); });
  describe(v, c.journey);
  describe_body(v, c);
  v.table(
      "imu", "Inertial measurement unit.", [&](ConfigVisitor& t) { describe_imu(t, c); }, &c.has_imu);
  auto& on = c.scenario.equipment;
  v.tables<sim::OdometerModel>("odometer", "A wheel with a counter.", on.odometers, describe_odometer);
  v.table(
      "gauge", "Gauge sensor of the trolley.", [&](ConfigVisitor& t) { describe_gauge(t, c.gauge); }, &c.has_gauge);
  v.table(
      "sleeper", "Ultrasonic sleeper sensor.", [&](ConfigVisitor& t) { describe_sleeper(t, c.sleeper); },
      &c.has_sleeper);
  v.table(
      "gnss", "GNSS receiver.", [&](ConfigVisitor& t) { describe_gnss(t, c.gnss); }, &c.has_gnss);
  v.table(
      "total_station", "Total station on the trolley.",
      [&](ConfigVisitor& t) { describe_total_station(t, c.total_station); }, &c.has_total_station);
  v.table(
      "axle_box", "Axle-box acceleration.", [&](ConfigVisitor& t) { describe_axle_box(t, c.axle_box); },
      &c.has_axle_box);
  v.table("temperature", "Of all sensors.", [&](ConfigVisitor& t) {
    t.value("start_degc", on.temperature.start, {.doc = "At the start.", .unit = "deg C", .min = -60, .max = 90});
    t.value("rate_degc_per_h", on.temperature.rate, {.doc = "Change.", .unit = "deg C/h", .scale = 1.0 / units::hour});
    t.value("amplitude_degc", on.temperature.amplitude, {.doc = "Of a wave on top.", .unit = "deg C", .min = 0});
    t.value("period_s", on.temperature.period, {.doc = "Of that wave.", .unit = "s", .positive = true});
  });
  v.tables<sim::Fault>("fault", "A fault put into the recording.", on.faults, describe_fault);
  v.table("truth", "What is told beside the recording.", [&](ConfigVisitor& t) {
    t.value("rate_hz", c.scenario.truth_rate, rate("Of the true trajectory.", 4000));
    t.value("csv", c.write_csv_truth, {.doc = "Write CSV beside HDF5."});
  });
}

}  // namespace versine::app
