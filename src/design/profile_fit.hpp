// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "versine/design/optimal_axis.hpp"

namespace versine::design {

/// Cant of every line and arc, with ramps of the transitions' shape between them: linear least squares with Huber's
/// weights. Does nothing when no sample has a cant. `distance` is each sample's foot on the axis.
void fit_cant(std::span<const TrackSample> samples, const std::vector<double>& distance, double huber,
              OptimalAxis& axis);

/// Gradients and parabolas: segmented by `segment`, then fitted in one solve. Does nothing when there are no heights.
[[nodiscard]] Expected<void> fit_profile(std::span<const TrackSample> samples, const std::vector<double>& distance,
                                         const OptimalAxisOptions& options, OptimalAxis& axis);

}  // namespace versine::design
