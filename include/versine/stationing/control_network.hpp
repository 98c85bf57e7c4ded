// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/stationing/readings.hpp"

namespace versine::stationing {

/// Unit vector along the plumb line, upwards, at a place in the survey frame: verticals converge towards the Earth's
/// centre, 0.16 arc-seconds in 5 m, 32 in a kilometre (sphere of 6371 km; the frame's origin lies on it).
[[nodiscard]] Eigen::Vector3d up_at(const Eigen::Vector3d& place);

/// Control points, found by name or by place.
class ControlNetwork {
 public:
  ControlNetwork() = default;
  /// Fails when a name stands for two places (more than 1 mm apart), a coordinate is not a number or a covariance is
  /// not one. A point that is listed twice with the same coordinates counts once.
  [[nodiscard]] static Expected<ControlNetwork> create(std::vector<ControlPoint> points);

  [[nodiscard]] const std::vector<ControlPoint>& points() const { return points_; }
  [[nodiscard]] const ControlPoint* find(std::string_view name) const;
  /// Indices of the points within `radius` m, unordered.
  [[nodiscard]] std::vector<std::size_t> within(const Eigen::Vector3d& place, double radius) const;
  /// The nearest point within `radius` m; nullptr when there is none.
  [[nodiscard]] const ControlPoint* nearest(const Eigen::Vector3d& place, double radius) const;
  /// The same network without the named points.
  [[nodiscard]] ControlNetwork without(const std::vector<std::string>& names) const;

 private:
  std::vector<ControlPoint> points_;
  std::unordered_map<std::string, std::size_t> by_name_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

/// Something doubtful in a list of control points, in words, with the points concerned.
struct ControlFinding {
  std::vector<std::string> points;
  std::string text;
};

/// Looks for what typing errors leave behind: two numbers at one place (closer than 5 mm), a point far from all others,
/// a height that stands out from those of the points around it.
[[nodiscard]] std::vector<ControlFinding> check(const ControlNetwork& network);

}  // namespace versine::stationing
