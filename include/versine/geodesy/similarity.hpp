// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "versine/core/error.hpp"

namespace versine::geodesy {

/// A point known in two systems. x, y, z are easting, northing, height (or any right-handed axes), m.
struct CommonPoint {
  std::string name;
  Eigen::Vector3d source = Eigen::Vector3d::Zero();
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  double sigma = 1e-3;  ///< of each coordinate, both systems together, m: sets the relative weight
};

struct SimilarityOptions {
  bool three_dimensional = false;  ///< 7 parameters; otherwise 4 in the plane, heights moved by their mean
  bool fixed_scale = false;        ///< 6 or 3 parameters: scale 1
  double significance = 0.001;     ///< of the test for outlying points (two-sided, Baarda's data snooping)
};

/// How a common point fits.
struct SimilarityResidual {
  std::string name;
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();  ///< target minus transformed source, m; z is 0 in the plane
  double normalized = 0.0;                             ///< largest residual over its own sigma; NaN without redundancy
  bool outlying = false;                               ///< left out of the adjustment
};

/// Similarity transformation (Helmert): target = translation + scale * rotation * source. Immutable value.
struct Similarity {
  Eigen::Vector3d source_centre = Eigen::Vector3d::Zero();  ///< both centres keep large coordinates exact
  Eigen::Vector3d target_centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double scale = 1.0;
  bool three_dimensional = false;
  double sigma0 = 0.0;  ///< of unit weight: 1 when the points' sigmas are right; NaN without redundancy
  int redundancy = 0;
  Eigen::VectorXd parameter_sigma;  ///< plane: translation x, y (m), rotation (rad), scale, height; space:
                                    ///< translation x, y, z, rotation x, y, z, scale. At the centre, with the given
                                    ///< sigmas; a fixed scale has none
  std::vector<SimilarityResidual> residuals;  ///< one per point, in the order given

  [[nodiscard]] Eigen::Vector3d apply(const Eigen::Vector3d& source) const;
  [[nodiscard]] Eigen::Vector3d inverse(const Eigen::Vector3d& target) const;
  /// Rotation in the plane, rad, counter-clockwise from x to y.
  [[nodiscard]] double rotation_z() const;
};

/// Weighted least squares in closed form (Umeyama 1991). Points that do not fit are found by data snooping, one after
/// the other while enough stay (Baarda 1968), and left out. Needs two common points in the plane, three not in a line
/// in space. Fails, naming what is missing, with fewer points, points at one place, or numbers that are not finite.
[[nodiscard]] Expected<Similarity> fit_similarity(const std::vector<CommonPoint>& points,
                                                  const SimilarityOptions& options = {});

}  // namespace versine::geodesy
