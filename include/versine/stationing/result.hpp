// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "versine/core/time.hpp"

namespace versine::stationing {

/// How one target fits.
struct TargetResult {
  std::string point;                                     ///< control point it was used as
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();    ///< observed minus adjusted, across, up and along the line, m
  Eigen::Vector3d normalized = Eigen::Vector3d::Zero();  ///< each residual over its own sigma (Baarda's w)
  Eigen::Vector3d redundancy = Eigen::Vector3d::Zero();  ///< redundancy numbers, 0 to 1
  Eigen::Vector3d detectable = Eigen::Vector3d::Zero();  ///< minimum detectable blunder (alpha 0.1 %, power 80 %), m
  /// Correction of the station (position m, theta rad, m-frame) per error of the control point's coordinates (truth
  /// minus given, m): what stations that share the point have in common.
  Eigen::Matrix<double, 6, 3> gain = Eigen::Matrix<double, 6, 3>::Zero();
  double point_test = 0.0;   ///< normalised size of the whole target's error; chi-square with 3 d.o.f.
  std::size_t readings = 0;  ///< sightings it is the mean of
};

/// A target that was left out, and why.
struct Exclusion {
  enum class Reason {
    blunder,        ///< the readings contradict the others
    moved,          ///< the point lies elsewhere than its coordinates say (seen from more than one station)
    wrong_name,     ///< the readings fit another control point: see `is`
    unknown_point,  ///< no control point has this number, and none lies where the readings point
    no_distance,    ///< angles only where three values are needed
  };
  std::string point;
  Reason reason = Reason::blunder;
  std::string is;                                    ///< name of the control point that the readings do fit
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< where the readings point minus the coordinates, m-frame, m
  double test = 0.0;                                 ///< point test that it failed; chi-square with 3 d.o.f.
};
[[nodiscard]] const char* to_string(Exclusion::Reason reason);

/// Whether the back-sights can carry the position.
struct GeometryVerdict {
  enum class Grade { good, weak, poor };
  Grade grade = Grade::good;
  double largest_gap = 0.0;          ///< between neighbouring directions, rad; above pi: all on one side
  std::vector<std::string> remarks;  ///< for a person: "all back-sights within 80 deg", "only 3 points", ...
};
[[nodiscard]] const char* to_string(GeometryVerdict::Grade grade);

/// Where the instrument stands and how it lies.
struct StationResult {
  std::string name;
  std::optional<Time> from, to;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();        ///< centre of the instrument, m-frame, m
  Eigen::Quaterniond q_ms = Eigen::Quaterniond::Identity();  ///< takes a vector from s to m
  double scale = 1.0;                                        ///< of the distances; 1 unless solved for
  /// Of the corrections (dp, theta, dscale) that lead to the truth: p + dp, Exp(theta) C_ms, scale + dscale; m, rad in
  /// the m-frame, 1. theta is the phi-angle of EQUATIONS, dp the negative position error. Scale's row is zero unless
  /// solved for.
  Eigen::Matrix<double, 7, 7> covariance = Eigen::Matrix<double, 7, 7>::Zero();
  double sigma0 = 0.0;  ///< a posteriori standard deviation of unit weight; 1 when the a priori sigmas hold
  int redundancy = 0;   ///< observations minus unknowns
  std::vector<TargetResult> targets;
  std::vector<Exclusion> excluded;
  GeometryVerdict geometry;
  std::vector<std::string> warnings;
};

}  // namespace versine::stationing
