// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/core/progress.hpp"
#include "versine/fusion/landmark_alignment.hpp"
#include "versine/fusion/landmark_model.hpp"
#include "versine/geodesy/geodetic.hpp"

namespace versine::fusion::landmark {

/// An epoch of the filters on the nominal path. Motion is since the node before.
struct Node {
  Time time;
  std::size_t sample = 0;  ///< counted from the first of the reckoning
  // As gyros and odometer say, in the trolley's frame at the node before:
  Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();  ///< attitude here
  Eigen::Vector3d way = Eigen::Vector3d::Zero();               ///< m
  Eigen::Vector3d way_moment = Eigen::Vector3d::Zero();        ///< m s: integral of velocity times time since then
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();              ///< rad/s, v-frame: bias and Earth rate taken off
  double integrated = 0.0;                                     ///< s over which the gyros were integrated
  double distance = 0.0, distance_moment = 0.0, duration = 0.0;
  double speed = 0.0;  ///< m/s, mean
  // From these and the start (`carry`):
  Eigen::Quaterniond q_nv = Eigen::Quaterniond::Identity();  ///< trolley's attitude, as reckoned
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();           ///< m, n-frame
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();          ///< m s, of the horizontal part (landmark_model.hpp)
  // From the landmarks (`place_nodes`):
  geodesy::Geodetic position;  ///< of the odometer's point
  Motion motion;
};

/// A sample between two nodes, in the trolley's frame at the node before: 24 bytes, so that a long recording stays in
/// reach of the caches. Rounding is 1e-8 rad and 1e-6 m at 30 m/s.
struct Between {
  Eigen::Vector3f turned = Eigen::Vector3f::Zero();  ///< vector part of the attitude quaternion
  Eigen::Vector3f way = Eigen::Vector3f::Zero();     ///< m
};

/// Dead reckoning without any correction (Jiang eq. 7).
struct Reckoning {
  std::size_t first = 0;         ///< IMU sample of node 0
  std::vector<Between> samples;  ///< one for each IMU sample from there on
  std::vector<Node> nodes;       ///< node 0 is the first sample
};

/// Integrates the gyros from `start` (Earth rate, transport rate) and sums the odometer along the trolley's x axis.
/// Nodes lie at the samples nearest to `stops` (ascending) and every `node_interval` in between.
/// Errors: a gap of the IMU while moving, values that are not numbers.
[[nodiscard]] Expected<Reckoning> reckon(const sensors::ImuSeries& imu, const Series<sensors::OdometerSample>& odometer,
                                         const StaticStart& start, const geodesy::Geodetic& place,
                                         const std::vector<Time>& stops, const LandmarkOptions& options,
                                         Progress& progress);

/// Carries the nodes' attitudes anew from another start: heading and gyro bias that differ a little from those reckoned
/// with. What that changes within a node interval is left out (1e-7 rad).
void restart(std::vector<Node>& nodes, const StaticStart& start, const geodesy::Geodetic& place,
             const LandmarkOptions& options);

/// Turns the nominal path by `heading` (rad), shrinks it by `scale` (1: by a hundred percent), and puts node `anchor`
/// at `position`: the nodes' positions and motions.
void place_nodes(std::vector<Node>& nodes, double heading, double scale, std::size_t anchor,
                 const geodesy::Geodetic& position);

}  // namespace versine::fusion::landmark
