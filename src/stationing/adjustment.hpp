// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>

#include "versine/stationing/free_station.hpp"
#include "versine/stationing/start_value.hpp"

/// The least-squares core of one station; free_station.cpp decides what goes in and what to think of the outcome.
namespace versine::stationing {

/// One target as observed: prism at `place` (m-frame), axes of its residual across, up and along the line of sight.
struct Observation {
  Eigen::Vector3d place;
  double direction = 0.0, zenith = 0.0, distance = 0.0;
  Eigen::Matrix3d covariance;  ///< of the residual: instrument and control point, m^2
  Eigen::Matrix3d whitening;   ///< inverse of the covariance's Cholesky factor
};

/// Observed minus computed, m: across (to the right), up, along. `v` is the target from the instrument in the s-frame.
/// Turning v by the observed direction keeps the difference of directions free of jumps.
template <class T>
Eigen::Matrix<T, 3, 1> misclosure(const Eigen::Matrix<T, 3, 1>& v, const T& scale, double direction, double zenith,
                                  double distance) {
  using std::atan2;
  using std::sqrt;
  const double c = std::cos(direction), s = std::sin(direction);
  const T x = c * v(0) + s * v(1), y = c * v(1) - s * v(0);
  const T horizontal = sqrt(v(0) * v(0) + v(1) * v(1));
  return {-atan2(y, x) * (distance * std::sin(zenith)), (atan2(horizontal, -v(2)) - zenith) * distance,
          scale * distance - sqrt(horizontal * horizontal + v(2) * v(2))};
}

/// Rows: unit vectors across, up and along the line of sight, m-frame, for a target seen from `pose`.
Eigen::Matrix3d line_axes(const Pose& pose, double direction, double zenith);

struct AdjustmentSettings {
  bool solve_scale = false;
  std::optional<Plumb> plumb;
  bool robust = false;  ///< Cauchy loss on whole targets instead of squares
};

struct Adjustment {
  Pose pose;
  double scale = 1.0;
  Eigen::Matrix<double, 7, 7> covariance = Eigen::Matrix<double, 7, 7>::Zero();
  std::vector<Eigen::Vector3d> whitened;              ///< residual of each target, whitened
  std::vector<Eigen::Matrix<double, 3, 7>> jacobian;  ///< whitened, of (dp, theta, dscale)
  double squares = 0.0;                               ///< sum of all squared whitened residuals
  int redundancy = 0;
  bool regular = false;  ///< false: the unknowns are not determined
};

/// Least squares from `start`. The attitude's unknown is a rotation vector in the m-frame.
Adjustment adjust(const std::vector<Observation>& observations, const Pose& start, double start_scale,
                  const AdjustmentSettings& settings);

}  // namespace versine::stationing
