// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <span>
#include <vector>

#include "versine/design/horizontal.hpp"

namespace versine::design {

/// The foot of a point on the axis.
struct AxisFoot {
  double distance = 0.0;    ///< along the axis, m; below 0 or above length() beyond an end, along the end tangent
  double offset = 0.0;      ///< from the axis to the point, m, positive right of it
  std::size_t element = 0;  ///< index of the element
  bool inside = false;      ///< false: the nearest place is an end of the axis, or the end of the searched range
};

/// A stretch of the axis to search, m along it.
struct AxisRange {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
};

/// Finds the nearest place of an axis to a point. Exact: the foot is perpendicular within 1e-9 m along the axis, and no
/// other place is nearer. The axis is cut into short pieces in its own order, and a binary tree of their bounding boxes
/// is searched by branch and bound: no allocation, logarithmic in length, and a range of distances is a range of
/// pieces. Safe to use from several threads at once.
class AxisIndex {
 public:
  explicit AxisIndex(HorizontalAxis axis);

  [[nodiscard]] const HorizontalAxis& axis() const { return axis_; }
  /// REQUIRES finite coordinates. An empty or outside range is searched at its nearest piece.
  [[nodiscard]] AxisFoot project(double easting, double northing, const AxisRange& range = {}) const;
  /// Point at a distance and an offset to the right: the inverse of `project`.
  [[nodiscard]] MapPose place(double distance, double offset) const;

 private:
  struct Box {
    double west, south, east, north;
  };
  struct Piece {
    double from, to;
    std::size_t element;
    MapPose start, end;
  };
  struct Search;
  void descend(std::size_t node, std::size_t first, std::size_t last, Search& search) const;
  void try_piece(std::size_t index, Search& search) const;

  HorizontalAxis axis_;
  std::vector<Piece> pieces_;
  std::vector<Box> tree_;  // heap order over a power of two of leaves
  std::size_t leaves_ = 1;
};

/// Feet of the points of one run in its order: the first by the whole axis (or near `start`), each following one within
/// `search` metres of the last, so that a run stays on its own turn where the line crosses or follows itself (spirals,
/// loops, reversing). Where a foot falls on the edge of its stretch, the whole axis is searched again.
[[nodiscard]] std::vector<AxisFoot> project_run(const AxisIndex& index, std::span<const MapPosition> points,
                                                double search = 50.0, const AxisRange& start = {});

}  // namespace versine::design
