// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "versine/stationing/result.hpp"

namespace versine::stationing {

/// Judges whether the targets used (`lines`: from the instrument, s-frame, m) can carry the station: enough of them,
/// all around, not too near, each checked by the others, the position as good as wanted.
[[nodiscard]] GeometryVerdict judge_geometry(std::span<const Eigen::Vector3d> lines, const StationResult& result,
                                             double wanted_sigma);

}  // namespace versine::stationing
