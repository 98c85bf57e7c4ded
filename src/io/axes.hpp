// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <string_view>

#include "versine/core/error.hpp"

namespace versine::io {

/// C_bs of sensor axes in words ("right-forward-up") or as a matrix: x_forward-right-down = C_bs * x_sensor.
[[nodiscard]] Expected<Eigen::Matrix3d> axes_from_words(std::string_view words, const std::string& file);
/// Checks that a matrix is a rotation within 1e-3.
[[nodiscard]] Expected<Eigen::Matrix3d> axes_from_matrix(const Eigen::Matrix3d& matrix, const std::string& file);

}  // namespace versine::io
