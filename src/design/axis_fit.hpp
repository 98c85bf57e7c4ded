// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "versine/design/optimal_axis.hpp"

namespace versine::design {

/// A chain of lines or arcs with a transition between every two, which the fit varies. Elements alternate: even ones
/// are constant, odd ones transitions.
struct Chain {
  MapPose start;
  std::vector<HorizontalElement> elements;
  std::vector<bool> fixed_length, fixed_curvature;  // per element; curvature of constant elements only
};

/// Curvatures of transitions follow their neighbours; kinds follow curvatures.
void connect(Chain& chain);

struct ChainFit {
  Chain chain;
  Eigen::MatrixXd covariance;
  std::vector<std::string> unknowns;
  std::vector<int> length_index, curvature_index;  // into the covariance, -1 when fixed
  Eigen::VectorXd offset, heading;                 // residuals per sample, m and rad
  std::vector<double> distance;                    // of each sample's foot
  std::size_t outliers = 0;
};

/// Fits a chain to samples. `with_covariance` is the costly part.
ChainFit fit_chain(const Chain& chain, std::span<const TrackSample> samples, double huber, bool with_covariance);

}  // namespace versine::design
