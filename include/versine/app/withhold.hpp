// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

#include "versine/app/survey_config.hpp"
#include "versine/geodesy/trajectory.hpp"
#include "versine/sensors/measurements.hpp"

namespace versine::app {

/// How well withheld GNSS positions were met (`[withhold]`).
struct WithheldErrors {
  std::size_t windows = 0, count = 0;
  double rms_horizontal = 0, p95_horizontal = 0, max_horizontal = 0, rms_vertical = 0;  ///< m
  double coverage = 0;  ///< share of horizontal components inside 1.96 sigma, sigma of solution and fix together
};

/// Takes the epochs inside the windows out of `gnss` and returns them.
[[nodiscard]] Series<sensors::GnssSample> withhold(Series<sensors::GnssSample>& gnss,
                                                   const SurveyConfig::Withhold& windows);

/// Compares hidden epochs with the solution at the antenna, interpolated to their times. Epochs outside the solution,
/// or in a gap of it, are not counted.
[[nodiscard]] WithheldErrors compare_withheld(const Series<sensors::GnssSample>& hidden,
                                              const geodesy::Trajectory& solution, const Eigen::Vector3d& lever_arm_b);

}  // namespace versine::app
