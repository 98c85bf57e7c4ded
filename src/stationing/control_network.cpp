// SPDX-License-Identifier: Apache-2.0
#include "versine/stationing/control_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace versine::stationing {
namespace {

constexpr double cell_size = 64.0;

std::int64_t cell(double north, double east) {
  const auto i = static_cast<std::int64_t>(std::floor(north / cell_size));
  const auto j = static_cast<std::int64_t>(std::floor(east / cell_size));
  return i * 1'000'003 + j;
}

}  // namespace

Eigen::Vector3d up_at(const Eigen::Vector3d& place) {
  return (place - Eigen::Vector3d(0.0, 0.0, 6.371e6)).normalized();
}

Expected<ControlNetwork> ControlNetwork::create(std::vector<ControlPoint> points) {
  ControlNetwork network;
  for (ControlPoint& p : points) {
    if (!p.position.allFinite() || !p.covariance.allFinite() || p.covariance.diagonal().minCoeff() < 0.0) {
      return fail({.field = fmt::format("control point {}", p.name),
                   .found = "a coordinate or sigma that is not a number",
                   .expected = "finite coordinates, sigmas of zero or more",
                   .advice = "correct the point in the control list"});
    }
    if (const ControlPoint* known = network.find(p.name)) {
      const double apart = (known->position - p.position).norm();
      if (apart <= 1e-3) continue;
      return fail({.field = fmt::format("control point {}", p.name),
                   .found = fmt::format("two entries, {:.3f} m apart", apart),
                   .expected = "one place for each number",
                   .advice = "remove the older coordinates, or rename one of the two points"});
    }
    const std::size_t i = network.points_.size();
    network.by_name_[p.name] = i;
    network.cells_[cell(p.position.x(), p.position.y())].push_back(i);
    network.points_.push_back(std::move(p));
  }
  return network;
}

const ControlPoint* ControlNetwork::find(std::string_view name) const {
  const auto it = by_name_.find(std::string(name));
  return it == by_name_.end() ? nullptr : &points_[it->second];
}

std::vector<std::size_t> ControlNetwork::within(const Eigen::Vector3d& place, double radius) const {
  std::vector<std::size_t> found;
  for (double n = place.x() - radius; n < place.x() + radius + cell_size; n += cell_size) {
    for (double e = place.y() - radius; e < place.y() + radius + cell_size; e += cell_size) {
      const auto it = cells_.find(cell(n, e));
      if (it == cells_.end()) continue;
      for (const std::size_t i : it->second) {
        if ((points_[i].position - place).norm() <= radius) found.push_back(i);
      }
    }
  }
  return found;
}

const ControlPoint* ControlNetwork::nearest(const Eigen::Vector3d& place, double radius) const {
  const ControlPoint* best = nullptr;
  for (const std::size_t i : within(place, radius)) {
    if (best == nullptr || (points_[i].position - place).norm() < (best->position - place).norm()) best = &points_[i];
  }
  return best;
}

ControlNetwork ControlNetwork::without(const std::vector<std::string>& names) const {
  std::vector<ControlPoint> kept;
  for (const ControlPoint& p : points_) {
    if (std::find(names.begin(), names.end(), p.name) == names.end()) kept.push_back(p);
  }
  return *create(std::move(kept));
}

std::vector<ControlFinding> check(const ControlNetwork& network) {
  const auto& points = network.points();
  std::vector<ControlFinding> findings;
  std::vector<double> nearest(points.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (double radius = 2.0 * cell_size; radius < 5000.0 && std::isinf(nearest[i]); radius *= 4.0) {
      for (const std::size_t j : network.within(points[i].position, radius)) {
        if (j != i) nearest[i] = std::min(nearest[i], (points[i].position - points[j].position).norm());
      }
    }
    for (const std::size_t j : network.within(points[i].position, 5e-3)) {
      if (j > i) {
        findings.push_back({{points[i].name, points[j].name},
                            fmt::format("{} and {} lie at one place", points[i].name, points[j].name)});
      }
    }
  }
  if (points.size() < 4) return findings;
  std::vector<double> sorted = nearest;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (nearest[i] > std::max(1000.0, 20.0 * usual)) {
      findings.push_back({{points[i].name},
                          std::isinf(nearest[i]) ? fmt::format("{} has no other point within 5 km", points[i].name)
                                                 : fmt::format("{} is {:.0f} m from the next point; usual are {:.0f} m",
                                                               points[i].name, nearest[i], usual)});
      continue;
    }
    std::vector<double> heights;
    for (const std::size_t j : network.within(points[i].position, std::max(100.0, 4.0 * usual))) {
      if (j != i) heights.push_back(-points[j].position.z());
    }
    if (heights.size() < 3) continue;
    std::sort(heights.begin(), heights.end());
    const double middle = heights[heights.size() / 2];
    const double range = std::max(3.0, heights[heights.size() - 1 - heights.size() / 8] - heights[heights.size() / 8]);
    if (std::abs(-points[i].position.z() - middle) > 3.0 * range) {
      findings.push_back({{points[i].name},
                          fmt::format("{} is {:.2f} m {} the points around it", points[i].name,
                                      std::abs(-points[i].position.z() - middle),
                                      -points[i].position.z() > middle ? "above" : "below")});
    }
  }
  return findings;
}

}  // namespace versine::stationing
