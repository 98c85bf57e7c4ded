// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "versine/stationing/control_network.hpp"

namespace versine::stationing {

/// Where the instrument stands and how it lies, without covariance.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();        ///< m-frame, m
  Eigen::Quaterniond q_ms = Eigen::Quaterniond::Identity();  ///< s to m
};

/// A target in the instrument frame with the coordinates that it should have.
struct Pair {
  Eigen::Vector3d local;   ///< s-frame, m
  Eigen::Vector3d global;  ///< m-frame, m
};

/// The rotation and translation that fit best in the sense of least squares (Kabsch 1976). `levelled`: the instrument's
/// z is held along the plumb line, and two points are enough. Nothing when the points lie on a line (or at one place).
[[nodiscard]] std::optional<Pose> rigid_transform(std::span<const Pair> pairs, bool levelled);

/// A start value that gross errors do not disturb.
struct Consensus {
  Pose pose;
  std::vector<bool> agrees;  ///< which pairs fit within the tolerance
  std::size_t count = 0;
};

/// The pose that the largest number of pairs agrees with to `tolerance` m: all of them when they do, otherwise the best
/// of the poses from three pairs (levelled: two). `largest_tilt`: of the instrument's z against the plumb line, rad.
[[nodiscard]] std::optional<Consensus> find_consensus(std::span<const Pair> pairs, double tolerance,
                                                      double largest_tilt, bool levelled);

/// Which control point each local target is, from the shape of the figure alone. Looks for the pose that puts the most
/// targets on control points; nothing when fewer than three fit, and nothing when another pose fits as many
/// (`ambiguous`).
struct Identification {
  Pose pose;
  std::vector<const ControlPoint*> point;  ///< for each local target; nullptr: none
  std::size_t count = 0;
  bool ambiguous = false;
};
[[nodiscard]] std::optional<Identification> identify(std::span<const Eigen::Vector3d> local,
                                                     const ControlNetwork& network, double tolerance,
                                                     double largest_tilt, bool levelled,
                                                     const std::optional<Eigen::Vector3d>& near = {});

}  // namespace versine::stationing
