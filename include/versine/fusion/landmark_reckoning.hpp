// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/core/progress.hpp"
#include "versine/fusion/landmark_alignment.hpp"
#include "versine/fusion/landmark_model.hpp"
#include "versine/geodesy/trajectory.hpp"

namespace versine::fusion::landmark {

/// An epoch of the filters on the nominal path. Motion is since the node before; `position` and `motion` follow from
/// `place_nodes`.
struct Node {
  Time time;
  std::size_t sample = 0;                                    ///< of Reckoning::points
  Eigen::Quaterniond q_nv = Eigen::Quaterniond::Identity();  ///< trolley's attitude, as reckoned
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();           ///< m, n-frame, since the node before
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();          ///< m s, of the horizontal part (landmark_model.hpp)
  double distance = 0.0, distance_moment = 0.0, duration = 0.0;
  double speed = 0.0;          ///< m/s, mean since the node before
  geodesy::Geodetic position;  ///< of the odometer's point
  Motion motion;
};

/// Dead reckoning without any correction (Jiang eq. 7). Each point holds its attitude q_nv (trolley to n), its
/// velocity, and in `moved` the way from the node before; positions follow when the nodes have been placed.
struct Reckoning {
  std::vector<geodesy::TrajectoryPoint> points;
  std::vector<Eigen::Vector3f> moved;  ///< m, n-frame, from the last node before to the point
  std::vector<Node> nodes;             ///< node 0 is the first point
};

/// Integrates the gyros from `start` (Earth rate, transport rate) and sums the odometer along the trolley's x axis.
/// Nodes lie at the samples nearest to `stops` (ascending) and every `node_interval` in between.
/// Errors: a gap of the IMU while moving, values that are not numbers.
[[nodiscard]] Expected<Reckoning> reckon(const sensors::ImuSeries& imu, const Series<sensors::OdometerSample>& odometer,
                                         const StaticStart& start, const geodesy::Geodetic& place,
                                         const std::vector<Time>& stops, const LandmarkOptions& options,
                                         Progress& progress);

/// Turns the nominal path by `heading` (rad), shrinks it by `scale` (1: by a hundred percent), and puts node `anchor`
/// at `position`: the nodes' positions and motions.
void place_nodes(std::vector<Node>& nodes, double heading, double scale, std::size_t anchor,
                 const geodesy::Geodetic& position);

}  // namespace versine::fusion::landmark
