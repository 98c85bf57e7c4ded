// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace versine::stationing {

/// Value that a chi-square variable of `degrees` exceeds with probability `alpha`.
double chi_square_quantile(int degrees, double alpha);

/// Square root of the non-centrality at which a one-dimensional test of significance `alpha` has `power`.
double noncentrality_root(double alpha, double power);

}  // namespace versine::stationing
