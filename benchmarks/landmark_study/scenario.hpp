// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/fusion/landmark_dead_reckoning.hpp"
#include "versine/geodesy/trajectory.hpp"
#include "versine/simulation/simulate.hpp"

namespace versine::study {

/// A trolley with the ring-laser unit of Jiang 2017, an odometer and a total station, on 400 m of straight track.
[[nodiscard]] simulation::Scenario jiang_trolley(double heading);
/// What a job would tell the landmark method about it.
[[nodiscard]] fusion::LandmarkOptions options_for(const simulation::Scenario& s);

/// Sum of squares in three directions.
struct Squares {
  Eigen::Array3d sum = Eigen::Array3d::Zero(), normalised = Eigen::Array3d::Zero(), inside = Eigen::Array3d::Zero();
  double count = 0.0;
  void add(const Eigen::Vector3d& e, const Eigen::Matrix3d& P) {
    sum += e.array().square();
    normalised += e.array().square() / P.diagonal().array();
    inside += (e.array().abs() < 1.96 * P.diagonal().array().sqrt()).cast<double>();
    ++count;
  }
  [[nodiscard]] Eigen::Array3d rms() const { return (sum / count).sqrt(); }
};

/// Error of a trajectory against the truth at a true point, north-east-down; false outside of it.
bool error_at(const geodesy::Trajectory& t, const geodesy::TrajectoryPoint& truth, Eigen::Vector3d& e,
              Eigen::Matrix3d& P);

}  // namespace versine::study
