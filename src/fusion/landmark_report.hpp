// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "landmark_placement.hpp"

/// What a run of landmark dead reckoning tells besides its result.
namespace versine::fusion::landmark {

/// Rejections and warnings; an error when most landmarks contradict each other.
[[nodiscard]] Expected<void> report_landmarks(const LandmarkInput& in, const Placement& p, const LandmarkOptions& o,
                                              RunRecord& record);

/// Warns where the reduced model may be off by more than the options' limit.
void warn_model(const std::vector<Stretch>& stretches, const LandmarkOptions& o, RunRecord& record);

/// Rank, condition and verdict into the run's record, where they reach run.json and the report.
void note_observability(const Observability& o, Time from, Time to, RunRecord& record);

}  // namespace versine::fusion::landmark
