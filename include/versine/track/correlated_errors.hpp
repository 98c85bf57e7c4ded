// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/filter/error_chain.hpp"
#include "versine/geodesy/trajectory.hpp"

namespace versine::track {

/// Joint errors for a trajectory that comes without: other software gives sigmas of single epochs only. Assumed is a
/// first-order Gauss-Markov process over the way travelled with these sigmas: `cov(e(a), e(b)) = sqrt(P_a) exp(-|a - b|
/// / length) sqrt(P_b)`. A difference over d << length then has the variance `2 d / length` of a single place, so a
/// length too short makes relative sigmas too large: the safe side. Between two fixes that the trajectory rests on,
/// their distance is a fair guess. REQUIRES length > 0, a trajectory that is not empty.
[[nodiscard]] filter::ErrorChain correlated_errors(const geodesy::Trajectory& trajectory, double length);

}  // namespace versine::track
