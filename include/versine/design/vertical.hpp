// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "versine/core/error.hpp"

namespace versine::design {

/// A point where two gradients meet, with the curve that rounds it. Distances are along the horizontal axis, m.
struct VerticalPoint {
  enum class Curve { none, parabola, circle };
  double distance = 0.0;  ///< m
  double height = 0.0;    ///< m, of the intersection, not of the curve
  Curve curve = Curve::none;
  /// Horizontal extent of the curve, m, half of it on each side (for a circle half of it within 1e-6 of itself).
  /// Zero when `radius` is given instead.
  double length = 0.0;
  double radius = 0.0;  ///< m, positive; the sign follows from the gradients. Used when `length` is zero
  std::string name;
};

/// Height and gradient of the axis. A gradient is a ratio (0.012 is 12 per mille), positive uphill.
struct VerticalPose {
  double height = 0.0;     ///< m
  double gradient = 0.0;   ///< d height / d distance
  double curvature = 0.0;  ///< d gradient / d distance, 1/m: positive in a sag
};

/// One element of the vertical alignment.
struct VerticalElement {
  enum class Shape { gradient, parabola, circle };
  Shape shape = Shape::gradient;
  double distance = 0.0;        ///< of its start, m
  double length = 0.0;          ///< horizontal, m
  double height = 0.0;          ///< at its start, m
  double gradient_start = 0.0;  ///< ratio
  double gradient_end = 0.0;
};

/// The vertical alignment: gradients and vertical curves over the distance along the horizontal axis. Immutable.
class Profile {
 public:
  /// From its intersection points in order of distance. The first and last carry no curve. Fails, naming the point,
  /// when distances do not increase or two curves overlap by more than 1 mm (less is shared between them).
  [[nodiscard]] static Expected<Profile> from_points(std::vector<VerticalPoint> points);
  /// One gradient from end to end.
  [[nodiscard]] static Profile constant(double distance, double height, double gradient, double length);
  /// Empty: a design without heights.
  Profile() = default;

  [[nodiscard]] bool empty() const { return elements_.empty(); }
  [[nodiscard]] const std::vector<VerticalElement>& elements() const { return elements_; }
  [[nodiscard]] const std::vector<VerticalPoint>& points() const { return points_; }
  /// Beyond the ends the end gradient goes on. NaN for an empty profile.
  [[nodiscard]] VerticalPose at(double distance) const;

 private:
  std::vector<VerticalPoint> points_;
  std::vector<VerticalElement> elements_;
};

}  // namespace versine::design
