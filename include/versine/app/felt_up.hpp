// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "versine/sensors/imu_grade.hpp"
#include "versine/sensors/measurements.hpp"
#include "versine/stationing/readings.hpp"

namespace versine::app {

/// How well a stand of `seconds` tells up, rad, each axis: noise and what changes between stands. What is the same at
/// all of them (bias, mounting) drops out in stationing::compute_stations.
[[nodiscard]] double felt_up_sigma(const sensors::TriadErrors& accelerometer, double seconds);

/// Gives each stationing with times the direction that the trolley's accelerometers felt as up in the meantime. Without
/// samples, or when the mean force is not gravity's, it stays as it is.
void feel_up(std::span<stationing::Stationing> stationings, const sensors::ImuSeries& imu,
             const sensors::TriadErrors& accelerometer);

}  // namespace versine::app
