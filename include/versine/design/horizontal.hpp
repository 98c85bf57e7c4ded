// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/design/transition.hpp"

namespace versine::design {

/// A place in the map plane, m.
struct MapPosition {
  double easting = 0.0;
  double northing = 0.0;
};

/// A place in the map plane with a direction.
struct MapPose {
  double easting = 0.0;   ///< m
  double northing = 0.0;  ///< m
  double heading = 0.0;   ///< rad, from grid north clockwise
};

/// A pose of the axis with its curvature.
struct AxisPose : MapPose {
  double curvature = 0.0;       ///< 1/m = d heading / ds: positive in a right-hand curve
  double curvature_rate = 0.0;  ///< d curvature / ds, 1/m^2
};

/// One element of the horizontal alignment, without its place. Lengths are map metres along the axis.
struct HorizontalElement {
  Shape shape = Shape::line;
  double length = 0.0;           ///< m, positive
  double curvature_start = 0.0;  ///< 1/m, positive right
  double curvature_end = 0.0;    ///< equal to curvature_start for lines (0) and arcs
  /// Viennese bend only: height of the centre of gravity over the rails times the change of the cant angle (end minus
  /// start, positive when the left rail rises), m rad. Zero gives the bend without cant.
  double cant_term = 0.0;
  std::string name;  ///< as in the file it came from; may be empty
};

/// Line of length L.
[[nodiscard]] HorizontalElement line(double length);
/// Arc; radius positive right, negative left.
[[nodiscard]] HorizontalElement arc(double length, double radius);
/// Transition between two radii, positive right, infinity for a straight: `transition(Shape::bloss, 80, inf, 600)`.
[[nodiscard]] HorizontalElement transition(Shape shape, double length, double radius_start, double radius_end);

/// Pose at distance `u` from the start of the element, which lies at `start`. One evaluator for all shapes: the heading
/// is the closed integral of the curvature, the position a 10-point Gauss quadrature of the heading (lines and arcs in
/// closed form): within 1e-8 m (measured: 3.1e-9) of the 48 buildingSMART reference curves. `u` is within [0, length].
[[nodiscard]] AxisPose pose_on(const HorizontalElement& element, const MapPose& start, double u);

/// The axis in the map plane: elements end to end, evaluated at the distance along it. Immutable.
class HorizontalAxis {
 public:
  /// Empty, to be assigned to; every other member REQUIRES an element.
  HorizontalAxis() = default;
  /// An element and the place where it starts.
  struct Placed {
    HorizontalElement element;
    MapPose start;
    double distance = 0.0;  ///< of its start along the axis, m
    double scale = 1.0;     ///< map metres per metre of distance: within 1e-4 of 1 where a gap was healed
  };

  /// Elements chained from `start`, each beginning where the last one ends, in its direction: no gap, no kink.
  /// Fails when an element has no positive finite length or finite curvature, naming it.
  [[nodiscard]] static Expected<HorizontalAxis> chain(const MapPose& start, std::vector<HorizontalElement> elements);
  /// Elements with their places (from a file; assemble.hpp finds gaps and heals small ones). `distance` is filled in.
  [[nodiscard]] static Expected<HorizontalAxis> place(std::vector<Placed> elements);

  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] const std::vector<Placed>& elements() const { return elements_; }
  /// Index of the element that holds the distance; the first or last one beyond the ends.
  [[nodiscard]] std::size_t element_at(double distance) const;
  /// Beyond the ends the axis goes on straight along its end tangent.
  [[nodiscard]] AxisPose at(double distance) const;
  /// As `at`, when the element is known: no search. `distance` is within the element.
  [[nodiscard]] AxisPose at(double distance, std::size_t element) const;
  [[nodiscard]] AxisPose end() const;

 private:
  std::vector<Placed> elements_;
  double length_ = 0.0;
};

}  // namespace versine::design
