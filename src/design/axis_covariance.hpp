// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

namespace versine::design {

/// Covariance of unknowns fitted by least squares to residuals that are correlated along the track: sandwich with the
/// residuals' own autocovariance (Newey and West 1987), tapered after Parzen. His window keeps the covariance positive
/// and, unlike Bartlett's, lets little of the power of irregularities (up to some 70 m) leak to the long waves that
/// elements are made of. `rows`: residuals per place (1 or 2, in turn); `step`: between places, m.
[[nodiscard]] Eigen::MatrixXd covariance_of_fit(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residual,
                                                int rows, double step);

}  // namespace versine::design
