// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "versine/core/run_record.hpp"
#include "versine/geodesy/trajectory.hpp"
#include "versine/sensors/measurements.hpp"

namespace versine::track {

/// The two phase-shifted switches of a Hall-effect wheel sensor (Chen 2018 section 3.5).
struct QuadratureSample {
  Time time;
  bool a = false, b = false;
};
struct QuadratureResult {
  Series<sensors::OdometerSample> odometer;
  std::size_t illegal = 0;  ///< both switches changed at once: an edge was missed; it counts for nothing
};
/// Signed distance from quadrature: forward is a before b (00, 10, 11, 01). One edge is `metres_per_edge`.
[[nodiscard]] QuadratureResult decode_quadrature(std::span<const QuadratureSample> samples, double metres_per_edge);

struct OdometerOptions {
  double window = 1.0;          ///< over which the wheels are compared, m
  double slip_distance = 0.01;  ///< disagreement over the window that counts as slip, m
};

/// One distance from two wheels. Over each window the mean of both increments is taken while they agree. Where they
/// differ by more than `slip_distance` beyond their long-term ratio, one wheel slips: the increment that is nearer to
/// the trajectory's is taken, or, without a trajectory, the longer one (a pushed wheel drags, it is not driven).
/// Each slip is a Finding of the record. With one odometer it is compared with the trajectory, when there is one.
[[nodiscard]] Series<sensors::OdometerSample> combine_odometers(
    std::span<const Series<sensors::OdometerSample>> odometers, const geodesy::Trajectory* trajectory,
    const OdometerOptions& options, RunRecord& record);

/// Distance at a time on a broken line through the samples; held constant beyond the ends.
[[nodiscard]] double distance_at(const Series<sensors::OdometerSample>& odometer, Time t);

}  // namespace versine::track
