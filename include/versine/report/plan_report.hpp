// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <vector>

#include "versine/report/facts.hpp"
#include "versine/report/figure.hpp"

/// The report and the figures of `versine plan`: figures 5 to 8 of Jiang 2017 for the user's own sensors.
namespace versine::report {

/// Sigmas along the way, mm.
struct PlanProfile {
  std::string name;
  std::vector<double> distance;              ///< m
  std::array<std::vector<double>, 3> sigma;  ///< lateral, vertical, longitudinal
};

/// Sigma at mid-interval over two errors of a sensor.
struct PlanMap {
  std::vector<double> x, y, sigma;  ///< sigma row by row, mm
};

struct PlanReport {
  Facts facts;
  double required_mm = 0.0, sigma_mm = 0.0;
  bool met = false;
  PlanProfile closed, smoothed;  ///< one interval by itself
  PlanProfile run;               ///< chained
  PlanMap lateral, vertical;     ///< over gyro bias (deg/h) and random walk (deg/sqrt(h))
  PlanMap longitudinal;          ///< over odometer scale (ppm) and its random walk (ppm/sqrt(s))
  std::vector<PlanProfile> methods;
  std::array<std::vector<double>, 3> errors;  ///< of the simulated runs, mm; empty: none were made
  std::array<double, 3> rms{}, predicted{}, coverage{};
  RawTable answers;       ///< question (a text key), answer
  RawTable grades;        ///< name, sigma_mm, largest_spacing_m
  RawTable method_table;  ///< name, lateral_mm, vertical_mm, longitudinal_mm
  RawTable sensors;       ///< key, value
};

[[nodiscard]] std::vector<Figure> plan_sigma_figures(const PlanReport& report, const Texts& texts);
[[nodiscard]] std::vector<Figure> plan_map_figures(const PlanReport& report, const Texts& texts);
[[nodiscard]] std::vector<Figure> plan_method_figures(const PlanReport& report, const Texts& texts);
[[nodiscard]] std::vector<Figure> plan_histograms(const PlanReport& report, const Texts& texts);

[[nodiscard]] Document plan_document(const PlanReport& report, const Texts& texts);

}  // namespace versine::report
