// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/app/config.hpp"
#include "versine/fusion/aided_ins.hpp"
#include "versine/fusion/landmark_options.hpp"

/// `method = "landmark"` of a survey job.
namespace versine::app {

/// Keys of `[landmark_method]`: what the method knows and the aided INS does not. The rest comes from `[imu]`,
/// `[odometer]`, `[landmarks]` and `[alignment]`, which both methods share.
void describe(ConfigVisitor& v, fusion::LandmarkOptions& o);

/// `own` with all that the job says for both methods.
[[nodiscard]] fusion::LandmarkOptions landmark_options(const fusion::AidedInsOptions& shared,
                                                       fusion::LandmarkOptions own);

/// Runs the method on the aided INS' input, so that everything downstream works unchanged.
[[nodiscard]] Expected<fusion::AidedInsResult> solve_by_landmarks(const fusion::AidedInsInput& input,
                                                                  const fusion::AidedInsOptions& shared,
                                                                  const fusion::LandmarkOptions& own,
                                                                  Progress& progress);

}  // namespace versine::app
