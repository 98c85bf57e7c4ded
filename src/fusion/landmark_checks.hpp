// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "versine/fusion/landmark_dead_reckoning.hpp"

/// What landmark dead reckoning asks of its input.
namespace versine::fusion::landmark {

/// Refuses what cannot give a result, with the cure.
[[nodiscard]] Expected<void> check_input(const LandmarkInput& in, const LandmarkOptions& o);

/// Indices of landmarks that lie in the recording and were taken standing. Others are rejected, or an error. `start`:
/// when dead reckoning begins; a landmark before it counts while the trolley has not moved since.
[[nodiscard]] Expected<std::vector<std::size_t>> usable_landmarks(const LandmarkInput& in, const LandmarkOptions& o,
                                                                  Time start, RunRecord& record);

}  // namespace versine::fusion::landmark
