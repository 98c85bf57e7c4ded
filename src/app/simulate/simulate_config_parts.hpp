// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string_view>
#include <utility>

#include "versine/app/simulate_config.hpp"
#include "versine/core/units.hpp"

/// The parts from which the scenario's description is put together, and the units that they share.
namespace versine::app::scenario {

namespace sim = simulation;
template <class Enum, std::size_t N>
using Words = std::array<std::pair<std::string_view, Enum>, N>;

[[nodiscard]] constexpr KeySpec metres(std::string_view doc, double min = -1e9) {
  return {.doc = doc, .unit = "m", .min = min};
}
[[nodiscard]] constexpr KeySpec millimetres(std::string_view doc, double min = 0.0) {
  return {.doc = doc, .unit = "mm", .scale = units::mm, .min = min};
}
[[nodiscard]] constexpr KeySpec seconds(std::string_view doc) {
  return {.doc = doc, .unit = "s", .min = 0};
}
[[nodiscard]] constexpr KeySpec share(std::string_view doc) {
  return {.doc = doc, .min = 0, .max = 1};
}
[[nodiscard]] constexpr KeySpec rate(std::string_view doc, double max) {
  return {.doc = doc, .unit = "Hz", .max = max, .positive = true};
}
[[nodiscard]] constexpr KeySpec count_of(std::string_view doc, std::string_view unit) {
  return {.doc = doc, .unit = unit, .min = 0};
}

/// Roll, pitch, yaw as three numbers in degrees.
void describe_euler(ConfigVisitor& v, std::string_view key, geodesy::Euler& e, std::string_view doc);

void describe_track(ConfigVisitor& v, SimulateConfig& c);
void describe_body(ConfigVisitor& v, SimulateConfig& c);
void describe_motion(ConfigVisitor& v, sim::Motion& m);

void describe_imu(ConfigVisitor& v, SimulateConfig& c);
void describe_odometer(ConfigVisitor& v, sim::OdometerModel& m);
void describe_gauge(ConfigVisitor& v, sim::GaugeModel& m);
void describe_sleeper(ConfigVisitor& v, sim::SleeperModel& m);
void describe_gnss(ConfigVisitor& v, sim::GnssModel& m);
void describe_total_station(ConfigVisitor& v, sim::TotalStationModel& m);
void describe_axle_box(ConfigVisitor& v, sim::AxleBoxModel& m);
void describe_fault(ConfigVisitor& v, sim::Fault& f);

}  // namespace versine::app::scenario
