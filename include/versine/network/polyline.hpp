// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace versine::network {

enum class End : unsigned char { begin, end };

/// A line in the plane of a network's map, with the distance along it in metres on the ground.
class Polyline {
 public:
  Polyline() = default;
  /// `scales` are map metres per ground metre at each point (Projection::distortion); empty: 1. Consecutive equal
  /// points are merged. Throws std::invalid_argument when fewer than two distinct points remain.
  explicit Polyline(std::span<const Eigen::Vector2d> points, std::span<const double> scales = {});

  [[nodiscard]] const std::vector<Eigen::Vector2d>& points() const { return points_; }
  /// Ground distance of each point from the first, m; strictly increasing.
  [[nodiscard]] const std::vector<double>& distances() const { return distances_; }
  [[nodiscard]] double length() const { return distances_.back(); }
  [[nodiscard]] const Eigen::Vector2d& at(End end) const {
    return end == End::begin ? points_.front() : points_.back();
  }

  /// The point at `distance`; beyond the ends along the first or last segment.
  [[nodiscard]] Eigen::Vector2d position(double distance) const;
  /// Unit vector of the chord from an end to the point `base` metres inside (the whole line when it is shorter).
  [[nodiscard]] Eigen::Vector2d inward(End end, double base) const;

  struct Projection {
    double distance = 0.0;  ///< along the line, m
    double offset = 0.0;    ///< from the line, map m, never negative
  };
  /// The nearest point of the segments [first, last) (all, when last is 0).
  [[nodiscard]] Projection project(const Eigen::Vector2d& point, std::size_t first = 0, std::size_t last = 0) const;

  /// The part between two distances. REQUIRES 0 <= from < to <= length().
  [[nodiscard]] Polyline part(double from, double to) const;

 private:
  [[nodiscard]] std::size_t segment_at(double distance) const;
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> distances_;
};

}  // namespace versine::network
