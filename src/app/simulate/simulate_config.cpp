// SPDX-License-Identifier: Apache-2.0
#include "versine/app/simulate_config.hpp"

#include "simulate_config_parts.hpp"

namespace versine::app {

void describe(ConfigVisitor& v, SimulateConfig& c) {
  using namespace scenario;
  v.value("job", c.job, {.doc = "Kind of this job.", .required = true, .example = "\"simulate\""});
  v.value("title", c.title, {.doc = "What is simulated."});
  v.value("seed", c.seed, {.doc = "Of the sensors' errors.", .min = 0, .max = 9e15});
  v.value("runs", c.runs, {.doc = "Recordings with the same truth and other errors.", .min = 1, .max = 1000000});
  v.value("start_gps_s", c.start_gps_s, {.doc = "GPS time of the start.", .unit = "s", .min = 0, .max = 4e9});
  v.table("track", "The line and how it lies.", [&](ConfigVisitor& t) { describe_track(t, c); });
  describe(v, c.journey);
  describe_body(v, c);
  v.table("motion", "How it moves.", [&](ConfigVisitor& t) { describe_motion(t, c.scenario.motion); });
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
