// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "versine/app/report_config.hpp"
#include "versine/fusion/planning_search.hpp"

/// The job file of `versine plan`.
namespace versine::app {

struct PlanMonteCarloConfig {
  int runs = 0;  ///< 0: none
  double seed = 1;
  double imu_rate = 100.0;
  double static_start = 0.0;
  bool flicker = false;
  std::optional<double> bias_instability, rate_random_walk, bias, random_walk;  ///< of the simulated gyro
};

struct PlanConfig {
  std::string job;
  std::string title;
  std::string grade = "rlg-jiang";
  std::optional<double> gyro_bias, gyro_random_walk, gyro_bias_instability, accelerometer_bias,
      accelerometer_random_walk;
  double required = 0.67e-3;
  double chord = 30.0;
  fusion::PlanBasis basis = fusion::PlanBasis::interval;
  bool compare_methods = true;
  int map_points = 61;
  double map_bias = 0.0, map_random_walk = 0.0, map_scale = 0.0, map_scale_walk = 0.0;
  PlanMonteCarloConfig monte_carlo;
  ReportConfig report;
  fusion::PlanCase plan;  ///< takes the rest; sensors filled in by read_plan_config
  PlanConfig();
};

void describe(ConfigVisitor& v, PlanConfig& c);

/// Reads a job and looks the gyro's grade up.
[[nodiscard]] Expected<PlanConfig> read_plan_config(const std::filesystem::path& path,
                                                    std::span<const std::string> overrides = {});

}  // namespace versine::app
