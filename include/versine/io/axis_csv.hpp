// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "versine/design/optimal_axis.hpp"

namespace versine::io {

/// The elements of a measured axis with standard deviations: horizontal elements with their cant first, then gradients.
[[nodiscard]] Expected<void> write_axis_csv(const std::filesystem::path& path, const design::OptimalAxis& axis);

}  // namespace versine::io
