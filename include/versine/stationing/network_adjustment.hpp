// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/stationing/control_network.hpp"
#include "versine/stationing/reduction.hpp"
#include "versine/stationing/result.hpp"

namespace versine::stationing {

/// What joins stations besides common points: the figure of their centres as a smoothed trajectory has it. The
/// covariance holds what their errors share, so that a figure may be precise in itself and hang loosely as a whole.
struct StationFigure {
  std::vector<std::string> stations;       ///< by name, each once
  std::vector<Eigen::Vector3d> positions;  ///< of the instrument's centre, m-frame, m
  Eigen::MatrixXd covariance;              ///< three rows a station, m^2; positive definite
};

struct NetworkOptions {
  std::optional<double> tilt_sigma;  ///< the stations are levelled this well, rad; none: each lies as the trolley lies
  bool free = false;                 ///< control points only place the network (inner constraints); they are not held
  double significance = 0.001;       ///< of the test of one target or control point
  bool snoop = true;                 ///< leave out what fails
};

struct AdjustedPoint {
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::optional<Eigen::Vector3d> offset;  ///< adjusted minus given coordinates, for control points
  double control_test = 0.0;              ///< of that offset, chi-square with 3 d.o.f.; 0 in a free adjustment
  bool moved = false;                     ///< the coordinates failed and were not held
};

struct NetworkResidual {
  std::string station, point;
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();    ///< observed minus adjusted: across, up, along, m
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();       ///< a priori, of the observation, m
  Eigen::Vector3d redundancy = Eigen::Vector3d::Zero();  ///< 0 to 1
  double test = 0.0;                                     ///< chi-square, 3 d.o.f.
  bool used = true;
};

struct NetworkResult {
  std::vector<AdjustedPoint> points;
  std::vector<StationResult> stations;  ///< centre of the instrument, attitude and their covariance
  std::vector<NetworkResidual> residuals;
  double sigma0 = 0.0;
  int redundancy = 0;
  std::vector<std::string> warnings;
};

/// Least squares of all stations and points of a survey together (Ceres). Start values come from the readings: stations
/// are chained by common points, from control points if there are any, otherwise from the first station.
/// Constrained: control points are observations with their covariance; one that fails its test is released, reported as
/// moved and estimated. Free: the shape is the readings' alone, the datum that of least sum of squared offsets from the
/// start values (inner constraints); sigma0 and the points' covariance do not depend on coordinates given.
/// Fails when the network falls apart, when nothing is redundant, and on a figure of stations that are not in it.
[[nodiscard]] Expected<NetworkResult> adjust_network(std::span<const ReducedStation> stations,
                                                     const ControlNetwork& control, const Instrument& instrument,
                                                     const NetworkOptions& options,
                                                     std::span<const StationFigure> figures = {});

}  // namespace versine::stationing
