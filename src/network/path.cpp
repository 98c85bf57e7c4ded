// SPDX-License-Identifier: Apache-2.0
#include "versine/network/path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "versine/geodesy/attitude.hpp"

namespace versine::network {

PathCoordinates::PathCoordinates(const Network& network, Path path) : path_(std::move(path)) {
  if (path_.empty()) throw std::invalid_argument("PathCoordinates: empty path");
  double start = 0.0;
  for (const auto& step : path_) {
    const auto& line = network.tracks.at(step.track).line;
    const std::size_t n = line.points().size();
    starts_.push_back(start);
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = step.reversed ? n - 1 - k : k;
      // Snapped ends differ by millimetres to decimetres: the gap belongs to no track and has no length.
      if (k == 0 && !points_.empty()) continue;
      points_.push_back(line.points()[i]);
      distances_.push_back(start + (step.reversed ? line.length() - line.distances()[i] : line.distances()[i]));
    }
    start += line.length();
  }
  starts_.push_back(start);
  headings_.reserve(points_.size() - 1);
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    const Eigen::Vector2d leg = points_[i + 1] - points_[i];
    const double heading = std::atan2(leg.x(), leg.y());
    headings_.push_back(i == 0 ? heading : headings_.back() + geodesy::wrap_pi(heading - headings_.back()));
  }
  // Two boxes a segment: a place is found without a search, however long the path.
  const std::size_t boxes = 2 * headings_.size();
  boxes_per_metre_ = static_cast<double>(boxes) / distances_.back();
  boxes_.reserve(boxes + 1);
  for (std::size_t b = 0, i = 0; b <= boxes; ++b) {
    const double d = static_cast<double>(b) / boxes_per_metre_;
    while (i + 1 < headings_.size() && distances_[i + 1] <= d) ++i;
    boxes_.push_back(static_cast<std::uint32_t>(i));
  }
}

std::size_t PathCoordinates::segment_at(double d) const {
  const double x = d * boxes_per_metre_;
  const auto box = x > 0.0 ? static_cast<std::size_t>(std::min(x, static_cast<double>(boxes_.size() - 2))) : 0;
  const auto begin = distances_.begin() + boxes_[box], end = distances_.begin() + boxes_[box + 1];
  auto it = std::upper_bound(begin + 1, end + 1, d) - 1;
  if (*it > d && it != distances_.begin()) --it;  // a box's edge is rounded
  return static_cast<std::size_t>(it - distances_.begin());
}

Eigen::Vector2d PathCoordinates::position(double d) const {
  const std::size_t i = segment_at(d);
  const double u = (d - distances_[i]) / (distances_[i + 1] - distances_[i]);
  return points_[i] + u * (points_[i + 1] - points_[i]);
}

Eigen::Vector2d PathCoordinates::position(double d, std::size_t& hint) const {
  while (hint + 2 < distances_.size() && distances_[hint + 1] <= d) ++hint;
  const double u = (d - distances_[hint]) / (distances_[hint + 1] - distances_[hint]);
  return points_[hint] + u * (points_[hint + 1] - points_[hint]);
}

Eigen::Vector2d PathCoordinates::derivative(double d, double step) const {
  return (position(d + 0.5 * step) - position(d - 0.5 * step)) / step;
}

double PathCoordinates::azimuth(double d, double base) const {
  const Eigen::Vector2d chord = derivative(d, base);
  const double near = headings_[segment_at(d)];
  return near + geodesy::wrap_pi(std::atan2(chord.x(), chord.y()) - near);
}

double PathCoordinates::curvature(double d, double base) const {
  return (azimuth(d + 0.5 * base, base) - azimuth(d - 0.5 * base, base)) / base;
}

PathCoordinates::Projection PathCoordinates::project(const Eigen::Vector2d& p, double from, double to) const {
  const std::size_t first = segment_at(from), last = segment_at(to);
  Projection best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i <= last; ++i) {
    const Eigen::Vector2d leg = points_[i + 1] - points_[i], rel = p - points_[i];
    const double length = distances_[i + 1] - distances_[i];
    const double low = i == first ? std::clamp((from - distances_[i]) / length, 0.0, 1.0) : 0.0;
    const double high = i == last ? std::clamp((to - distances_[i]) / length, 0.0, 1.0) : 1.0;
    const double u = std::clamp(rel.dot(leg) / leg.squaredNorm(), low, std::max(low, high));
    const Eigen::Vector2d off = rel - u * leg;
    if (off.squaredNorm() < least) {
      least = off.squaredNorm();
      const double side = leg.y() * off.x() - leg.x() * off.y();  // positive to the right
      best = {distances_[i] + u * length, std::copysign(std::sqrt(least), side)};
    }
  }
  return best;
}

PathCoordinates::Place PathCoordinates::place(double d) const {
  const auto it = std::upper_bound(starts_.begin() + 1, starts_.end() - 1, d);
  const auto i = static_cast<std::size_t>(it - starts_.begin()) - 1;
  const double inside = std::clamp(d - starts_[i], 0.0, starts_[i + 1] - starts_[i]);
  const double distance = path_[i].reversed ? starts_[i + 1] - starts_[i] - inside : inside;
  return {path_[i], i, distance};
}

std::size_t first_infeasible(const Network& network, const Path& path) {
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Connection wanted{path[i], path[i + 1]};
    const auto key = [](const Connection& c) { return std::pair(c.from.state(), c.to.state()); };
    const auto it = std::lower_bound(network.connections.begin(), network.connections.end(), key(wanted),
                                     [&](const Connection& c, const auto& k) { return key(c) < k; });
    if (it == network.connections.end() || key(*it) != key(wanted)) return i;
  }
  return path.size();
}

}  // namespace versine::network
