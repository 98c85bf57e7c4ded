// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "versine/app/config.hpp"
#include "versine/app/recording_config.hpp"
#include "versine/app/simulate_journey.hpp"
#include "versine/simulation/scenario.hpp"

/// The scenario file of `versine simulate`.
namespace versine::app {

/// An element of the horizontal alignment as a scenario writes it.
struct ElementConfig {
  design::Shape shape = design::Shape::line;
  enum class Turn { right, left };
  Turn turn = Turn::right;
  double length = 0.0;                             ///< m
  std::optional<double> radius;                    ///< of an arc, m
  std::optional<double> radius_start, radius_end;  ///< of a transition, m; 0: straight; default: the neighbours'
};

struct SimulateConfig {
  std::string job;
  std::string title;
  double seed = 1;
  int runs = 1;
  double start_gps_s = 1.4e9;
  // Where the line comes from.
  InputPath alignment_file, gradients_file, stationing_file, table_file;
  std::string alignment_name, crs;
  double easting = 0.0, northing = 0.0, heading = 0.0, mileage = 0.0;
  std::vector<ElementConfig> horizontal;
  std::vector<design::VerticalPoint> vertical;
  std::vector<design::CantPoint> cant;
  std::vector<design::ChainageEquation> chainage;
  // The instrument.
  ImuErrorsConfig imu_errors;
  bool has_vehicle = false, has_imu = false, has_gauge = false, has_sleeper = false, has_gnss = false,
       has_total_station = false, has_axle_box = false;
  simulation::Vehicle vehicle;
  simulation::ImuModel imu;
  simulation::GaugeModel gauge;
  simulation::SleeperModel sleeper;
  simulation::GnssModel gnss;
  simulation::TotalStationModel total_station;
  simulation::AxleBoxModel axle_box;
  bool write_rates = false;
  bool write_csv_truth = true;
  JourneyConfig journey;          ///< instead of the scenario's track and motion
  simulation::Scenario scenario;  ///< takes all the rest directly
};

void describe(ConfigVisitor& v, SimulateConfig& c);

/// Reads a scenario file and builds the scenario: alignment put together or read, instrument looked up. What does not
/// fit together is an Error with the key and the cure.
[[nodiscard]] Expected<SimulateConfig> read_simulate_config(const std::filesystem::path& path,
                                                            std::span<const std::string> overrides = {});

}  // namespace versine::app
