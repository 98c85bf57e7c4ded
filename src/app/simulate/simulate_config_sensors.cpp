// SPDX-License-Identifier: Apache-2.0
// Keys of the sensors and of their faults.
#include "simulate_config_parts.hpp"

namespace versine::app::scenario {

namespace {
void describe_stretch(ConfigVisitor& v, sim::Stretch& s, bool time) {
  v.value(time ? "from_s" : "from_m", s.from, {.doc = "Beginning.", .unit = time ? "s" : "m"});
  v.value(time ? "to_s" : "to_m", s.to, {.doc = "End.", .unit = time ? "s" : "m"});
}
}  // namespace

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
  v.value("faces", m.faces, {.doc = "In which each point is read: 1, or 2.", .min = 1, .max = 2});
  v.value("collimation_arcsec", m.collimation,
          {.doc = "Error of the instrument; two faces cancel it.", .unit = "arcsec", .scale = units::arcsec});
  v.value("index_error_arcsec", m.index_error,
          {.doc = "Of the vertical circle, as before.", .unit = "arcsec", .scale = units::arcsec});
  v.value("sigma_angle_arcsec", m.sigma_angle,
          {.doc = "Of directions and zenith angles in both faces once (ISO 17123-3).",
           .unit = "arcsec",
           .scale = units::arcsec,
           .min = 0});
  v.value("sigma_distance_mm", m.sigma_distance, millimetres("Of distances."));
  v.value("sigma_distance_ppm", m.sigma_distance_ppm,
          {.doc = "Of distances.", .unit = "ppm", .scale = units::ppm, .min = 0});
  v.value("refraction", m.refraction, {.doc = "Coefficient k of the light's bending.", .min = -5, .max = 5});
  v.value("sighting_blunder", m.sighting_blunder, share("Probability that a sighting is wrong."));
  v.value("sighting_blunder_mm", m.sighting_blunder_size, millimetres("By how much."));
  v.value("moved_points", m.moved_points, {.doc = "Control points that have moved since their survey.", .min = 0});
  v.value("moved_mm", m.moved_by, millimetres("By how much."));
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

}  // namespace versine::app::scenario
