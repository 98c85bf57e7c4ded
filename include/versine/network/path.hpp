// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/network/network.hpp"

namespace versine::network {

/// A sequence of oriented tracks, each entered where the one before is left.
using Path = std::vector<OrientedTrack>;

/// Path coordinates (Roth 2018 section III-C): positions on a path as one distance d, 0 at the beginning of its first
/// track, in metres on the ground. Self-contained: it copies the geometry that it needs.
class PathCoordinates {
 public:
  PathCoordinates() = default;
  /// REQUIRES a path that is not empty. Whether its transitions are feasible is the graph's business.
  PathCoordinates(const Network& network, Path path);

  [[nodiscard]] const Path& path() const { return path_; }
  [[nodiscard]] double length() const { return distances_.back(); }
  /// Distance at which the i-th track begins; starts().back() is length().
  [[nodiscard]] const std::vector<double>& starts() const { return starts_; }

  /// Vertices, map m relative to Network::origin, and the distance of each.
  [[nodiscard]] std::span<const Eigen::Vector2d> points() const { return points_; }
  [[nodiscard]] std::span<const double> distances() const { return distances_; }

  /// phi(P, d) of eq. 2: map point relative to Network::origin. Beyond the ends along the first or last segment.
  [[nodiscard]] Eigen::Vector2d position(double d) const;
  /// The same for increasing d: `hint` is where the search starts, 0 at first; it is moved along.
  [[nodiscard]] Eigen::Vector2d position(double d, std::size_t& hint) const;
  /// Derivative of phi by central difference over `step` metres (eq. 17); its length is the map's scale.
  [[nodiscard]] Eigen::Vector2d derivative(double d, double step) const;
  /// Azimuth of the path from map north, clockwise, rad, continuous along the path; the direction of the chord over
  /// `base` metres around d.
  [[nodiscard]] double azimuth(double d, double base) const;
  /// Change of azimuth per metre (positive to the right), 1/m, from azimuths `base` metres apart.
  [[nodiscard]] double curvature(double d, double base) const;

  /// psi(p, P) of eq. 3: the nearest point within [from, to], distance and offset (positive to the right of the path).
  struct Projection {
    double distance = 0.0;
    double offset = 0.0;
  };
  [[nodiscard]] Projection project(const Eigen::Vector2d& p, double from, double to) const;
  [[nodiscard]] Projection project(const Eigen::Vector2d& p) const { return project(p, 0.0, length()); }

  /// A place on the path in the terms of its track.
  struct Place {
    OrientedTrack track;
    std::size_t index = 0;  ///< of the track in the path
    double distance = 0.0;  ///< from the track's own beginning, m
  };
  [[nodiscard]] Place place(double d) const;

 private:
  [[nodiscard]] std::size_t segment_at(double d) const;
  Path path_;
  std::vector<double> starts_;
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> distances_;
  std::vector<double> headings_;      // of each segment, unwrapped
  std::vector<std::uint32_t> boxes_;  // segment in which each of equal parts of the path begins
  double boxes_per_metre_ = 0.0;
};

/// Whether every transition of a path exists in the network. The index of the first that does not, else path.size().
[[nodiscard]] std::size_t first_infeasible(const Network& network, const Path& path);

}  // namespace versine::network
