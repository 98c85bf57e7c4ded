// SPDX-License-Identifier: Apache-2.0
#include "versine/stationing/start_value.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace versine::stationing {
namespace {

bool upright(const Pose& pose, double largest_tilt) {
  const Eigen::Vector3d up = pose.q_ms * Eigen::Vector3d(0.0, 0.0, -1.0);
  return up.dot(up_at(pose.position)) >= std::cos(largest_tilt);
}

/// Calls `visit(i, j, k)` for each choice of three (levelled: two, k = j), distant ones first would not matter.
template <class Visit>
void for_each_sample(std::size_t n, bool levelled, const Visit& visit) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      if (levelled) {
        visit(i, j, j);
      } else {
        for (std::size_t k = j + 1; k < n; ++k) visit(i, j, k);
      }
    }
  }
}

bool same_length(const Pair& a, const Pair& b, double tolerance) {
  return std::abs((a.local - b.local).norm() - (a.global - b.global).norm()) <= tolerance;
}

Consensus agreement(std::span<const Pair> pairs, const Pose& pose, double tolerance, double& squares) {
  Consensus c{.pose = pose, .agrees = std::vector<bool>(pairs.size())};
  squares = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double error = (pose.position + pose.q_ms * pairs[i].local - pairs[i].global).norm();
    c.agrees[i] = error <= tolerance;
    if (c.agrees[i]) ++c.count, squares += error * error;
  }
  return c;
}

}  // namespace

std::optional<Pose> rigid_transform(std::span<const Pair> pairs, bool levelled) {
  if (pairs.size() < (levelled ? 2u : 3u)) return {};
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = a;
  for (const Pair& p : pairs) a += p.local, b += p.global;
  a /= static_cast<double>(pairs.size());
  b /= static_cast<double>(pairs.size());
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero(), spread = h;
  for (const Pair& p : pairs) {
    h += (p.local - a) * (p.global - b).transpose();
    spread += (p.local - a) * (p.local - a).transpose();
  }
  if (levelled) {  // the plumb line as a pair of its own, so heavy that only the azimuth is left to the points
    const double weight = 1e6 * std::max(1.0, spread.trace());
    h += weight * Eigen::Vector3d(0.0, 0.0, -1.0) * up_at(b).transpose();
    if (!(spread.topLeftCorner<2, 2>().trace() > 1e-4)) return {};
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(h, Eigen::ComputeFullU | Eigen::ComputeFullV);
  // A line leaves the rotation about itself open: the second singular value must stand for more than noise.
  if (!levelled && !(svd.singularValues()(1) > 1e-6 * svd.singularValues()(0) && svd.singularValues()(1) > 1e-4)) {
    return {};
  }
  Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
  sign(2, 2) = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  Pose pose;
  pose.q_ms = Eigen::Quaterniond(Eigen::Matrix3d(svd.matrixV() * sign * svd.matrixU().transpose())).normalized();
  pose.position = b - pose.q_ms * a;
  return pose;
}

std::optional<Consensus> find_consensus(std::span<const Pair> pairs, double tolerance, double largest_tilt,
                                        bool levelled) {
  double squares = 0.0;
  if (const auto pose = rigid_transform(pairs, levelled)) {
    Consensus all = agreement(pairs, *pose, tolerance, squares);
    if (all.count == pairs.size() && upright(*pose, largest_tilt)) return all;
  }
  std::optional<Consensus> best;
  double best_squares = 0.0;
  std::vector<Pair> sample;
  for_each_sample(pairs.size(), levelled, [&](std::size_t i, std::size_t j, std::size_t k) {
    if (!same_length(pairs[i], pairs[j], 2.0 * tolerance)) return;
    sample = {pairs[i], pairs[j]};
    if (k != j) {
      if (!same_length(pairs[i], pairs[k], 2.0 * tolerance) || !same_length(pairs[j], pairs[k], 2.0 * tolerance))
        return;
      sample.push_back(pairs[k]);
    }
    const auto pose = rigid_transform(sample, levelled);
    if (!pose || !upright(*pose, largest_tilt)) return;
    Consensus c = agreement(pairs, *pose, tolerance, squares);
    if (!best || c.count > best->count || (c.count == best->count && squares < best_squares)) {
      best = std::move(c);
      best_squares = squares;
    }
  });
  if (!best || best->count < (levelled ? 2u : 3u)) return {};
  sample.clear();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (best->agrees[i]) sample.push_back(pairs[i]);
  }
  if (const auto pose = rigid_transform(sample, levelled)) best->pose = *pose;
  return best;
}

namespace {

/// The base: the two local targets that lie farthest apart.
std::pair<std::size_t, std::size_t> longest_base(std::span<const Eigen::Vector3d> local) {
  std::pair<std::size_t, std::size_t> base{0, 1};
  double longest = 0.0;
  for (std::size_t i = 0; i < local.size(); ++i) {
    for (std::size_t j = i + 1; j < local.size(); ++j) {
      if ((local[i] - local[j]).norm() > longest) longest = (local[i] - local[j]).norm(), base = {i, j};
    }
  }
  return base;
}

Identification place_targets(std::span<const Eigen::Vector3d> local, const ControlNetwork& network, const Pose& pose,
                             double tolerance) {
  Identification found{.pose = pose, .point = std::vector<const ControlPoint*>(local.size(), nullptr)};
  for (std::size_t i = 0; i < local.size(); ++i) {
    found.point[i] = network.nearest(pose.position + pose.q_ms * local[i], tolerance);
    if (found.point[i] != nullptr) ++found.count;
  }
  return found;
}

}  // namespace

std::optional<Identification> identify(std::span<const Eigen::Vector3d> local, const ControlNetwork& network,
                                       double tolerance, double largest_tilt, bool levelled,
                                       const std::optional<Eigen::Vector3d>& near) {
  if (local.size() < 3) return {};
  const auto [i, j] = longest_base(local);
  const double base = (local[i] - local[j]).norm();
  double reach = 0.0;
  for (const auto& l : local) reach = std::max(reach, l.norm());
  const auto& points = network.points();
  std::optional<Identification> best;
  for (std::size_t a = 0; a < points.size(); ++a) {
    if (near && (points[a].position - *near).norm() > reach + 50.0) continue;
    const auto around = network.within(points[a].position, base + reach);
    for (const std::size_t b : around) {
      if (b == a || std::abs((points[a].position - points[b].position).norm() - base) > tolerance) continue;
      for (std::size_t k = 0; k < local.size(); ++k) {
        if (k == i || k == j) continue;
        const double ik = (local[k] - local[i]).norm(), jk = (local[k] - local[j]).norm();
        for (const std::size_t c : around) {
          if (std::abs((points[c].position - points[a].position).norm() - ik) > tolerance ||
              std::abs((points[c].position - points[b].position).norm() - jk) > tolerance) {
            continue;
          }
          const std::vector<Pair> sample{
              {local[i], points[a].position}, {local[j], points[b].position}, {local[k], points[c].position}};
          const auto pose = rigid_transform(sample, levelled);
          if (!pose || !upright(*pose, largest_tilt)) continue;
          Identification found = place_targets(local, network, *pose, tolerance);
          if (found.count < 3) continue;
          const bool elsewhere = best && (found.pose.position - best->pose.position).norm() > 1.0;
          if (!best || found.count > best->count) {
            best = std::move(found);
          } else if (found.count == best->count && elsewhere) {
            best->ambiguous = true;
          }
        }
      }
    }
  }
  return best;
}

}  // namespace versine::stationing
