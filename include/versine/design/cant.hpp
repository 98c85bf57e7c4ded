// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "versine/core/error.hpp"
#include "versine/design/transition.hpp"

namespace versine::design {

/// Cant at a distance, and how it goes on to the next point.
/// Cant is signed: positive when the left rail is higher, so a right-hand curve (positive curvature) has positive cant.
/// It is the height difference over the 1500 mm of the rail-head centres, m, as EN 13848's cross level.
struct CantPoint {
  double distance = 0.0;         ///< m along the horizontal axis
  double cant = 0.0;             ///< m
  Shape ramp = Shape::clothoid;  ///< towards the next point; clothoid is the straight ramp
};

/// Cant and its rate.
struct CantPose {
  double cant = 0.0;  ///< m, positive: left rail higher
  double rate = 0.0;  ///< d cant / d distance
};

/// The cant of the design over the distance along the horizontal axis. Immutable.
class CantProfile {
 public:
  /// From points in order of distance; two points at one distance are a step (they happen in switches).
  /// Fails, naming the point, when distances decrease or a number is not finite.
  [[nodiscard]] static Expected<CantProfile> from_points(std::vector<CantPoint> points);
  /// Empty: a design without cant.
  CantProfile() = default;

  [[nodiscard]] bool empty() const { return points_.empty(); }
  [[nodiscard]] const std::vector<CantPoint>& points() const { return points_; }
  /// Beyond the ends the end value holds. NaN for an empty profile.
  [[nodiscard]] CantPose at(double distance) const;

 private:
  std::vector<CantPoint> points_;
};

}  // namespace versine::design
