// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>

#include "versine/sensors/measurements.hpp"

namespace versine::fusion {

/// One cause of a landmark's error that may be a cause of others' too: a control point, or a station that measured
/// several prisms. Its share of the error (rows of sensors::SharedError) is `effect` v, with v of unit variance.
struct ErrorCause {
  std::string name;  ///< the same name means the same v
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6> effect;
};

/// Joint covariance of the parts that two landmarks share with others.
[[nodiscard]] Eigen::Matrix<double, 6, 6> shared_covariance(std::span<const ErrorCause> a,
                                                            std::span<const ErrorCause> b);

/// The shared errors of landmarks in order of time, from the causes of each, as a Gauss-Markov process: the covariance
/// of each landmark is exact, that of neighbours as nearly as one correlation per element can tell (exact for positions
/// that correlate axis by axis), that of landmarks further apart follows. A landmark without causes gets none and is independent. `rows`: 3, positions alone; 6, with attitudes.
[[nodiscard]] std::vector<std::optional<sensors::SharedError>> share_errors(
    std::span<const std::vector<ErrorCause>> causes, int rows);

}  // namespace versine::fusion
