// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
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
  /// Of the mean scale of the wheels as delivered, 1: a millimetre of wear on a wheel of 0.3 m is 3e-3, a calibrated
  /// wheel has 3e-4. 0: the wheels' own scale stays.
  double scale_sigma = 3e-4;
  Eigen::Vector3d forward =
      Eigen::Vector3d::UnitX();  ///< the trolley's x axis in the axes of the trajectory's attitude
};

/// Wheels combined: horizontal way of the trolley.
struct CombinedOdometer {
  Series<sensors::OdometerSample> odometer;
  double scale = 1.0;        ///< by which the mean of the wheels was multiplied
  double scale_sigma = 0.0;  ///< of what is left, 1; as given when there is no trajectory
};

/// One distance from two wheels. Over each window the mean of both increments is taken while they agree. Where they
/// differ by more than `slip_distance` beyond their long-term ratio, one wheel slips: the increment that is nearer to
/// the trajectory's is taken, or, without a trajectory, the longer one (a pushed wheel drags, it is not driven).
/// Each slip is a Finding of the record. With one odometer it is compared with the trajectory, when there is one.
/// A trajectory also levels the way (a wheel rolls along the slope) and calibrates it: the scale is the mean of 1 and
/// of the ratio of both ways, by their variances. A trajectory with landmarks or GNSS knows it to 1e-6 or 1e-5; one
/// that has its length from the same wheel adds nothing, and by its own sigma claims little.
[[nodiscard]] CombinedOdometer combine_odometers(std::span<const Series<sensors::OdometerSample>> odometers,
                                                 const geodesy::Trajectory* trajectory, const OdometerOptions& options,
                                                 RunRecord& record);

/// Distance at a time on a broken line through the samples; held constant beyond the ends.
[[nodiscard]] double distance_at(const Series<sensors::OdometerSample>& odometer, Time t);

}  // namespace versine::track
