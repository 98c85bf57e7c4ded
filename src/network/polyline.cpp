// SPDX-License-Identifier: Apache-2.0
#include "versine/network/polyline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace versine::network {

Polyline::Polyline(std::span<const Eigen::Vector2d> points, std::span<const double> scales) {
  if (!scales.empty() && scales.size() != points.size()) throw std::invalid_argument("Polyline: one scale a point");
  points_.reserve(points.size());
  distances_.reserve(points.size());
  double last_scale = 1.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d& p = points[i];
    const double scale = scales.empty() ? 1.0 : scales[i];
    if (!(scale > 0.0)) throw std::invalid_argument("Polyline: scales must be positive");
    const double step = points_.empty() ? 0.0 : (p - points_.back()).norm() / (0.5 * (scale + last_scale));
    if (!points_.empty() && !(step > 0.0)) continue;
    distances_.push_back(points_.empty() ? 0.0 : distances_.back() + step);
    points_.push_back(p);
    last_scale = scale;
  }
  if (points_.size() < 2) throw std::invalid_argument("Polyline: needs two distinct points");
}

std::size_t Polyline::segment_at(double distance) const {
  const auto it = std::upper_bound(distances_.begin() + 1, distances_.end() - 1, distance);
  return static_cast<std::size_t>(it - distances_.begin()) - 1;
}

Eigen::Vector2d Polyline::position(double distance) const {
  const std::size_t i = segment_at(distance);
  const double u = (distance - distances_[i]) / (distances_[i + 1] - distances_[i]);
  return points_[i] + u * (points_[i + 1] - points_[i]);
}

Eigen::Vector2d Polyline::inward(End end, double base) const {
  const double inside = std::min(base, length());
  const Eigen::Vector2d chord = end == End::begin ? Eigen::Vector2d(position(inside) - points_.front())
                                                  : Eigen::Vector2d(position(length() - inside) - points_.back());
  const double norm = chord.norm();
  // A closed loop has no chord; its first segment still has a direction.
  if (norm > 1e-6) return chord / norm;
  const std::size_t n = points_.size();
  return (end == End::begin ? points_[1] - points_[0] : points_[n - 2] - points_[n - 1]).normalized();
}

Polyline::Projection Polyline::project(const Eigen::Vector2d& point, std::size_t first, std::size_t last) const {
  if (last == 0) last = points_.size() - 1;
  Projection best{0.0, std::numeric_limits<double>::infinity()};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i < last; ++i) {
    const Eigen::Vector2d leg = points_[i + 1] - points_[i], to = point - points_[i];
    const double u = std::clamp(to.dot(leg) / leg.squaredNorm(), 0.0, 1.0);
    const double square = (to - u * leg).squaredNorm();
    if (square < least) {
      least = square;
      best = {distances_[i] + u * (distances_[i + 1] - distances_[i]), std::sqrt(square)};
    }
  }
  return best;
}

Polyline Polyline::part(double from, double to) const {
  Polyline out;
  out.points_.push_back(position(from));
  out.distances_.push_back(0.0);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (distances_[i] > from && distances_[i] < to) {
      out.points_.push_back(points_[i]);
      out.distances_.push_back(distances_[i] - from);
    }
  }
  out.points_.push_back(position(to));
  out.distances_.push_back(to - from);
  return out;
}

}  // namespace versine::network
