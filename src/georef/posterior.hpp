// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "versine/georef/georeference.hpp"

namespace versine::georef {

/// Probabilities from the evidence; most probable first.
void set_posterior(std::vector<PathSolution>& paths);
/// Makes one of paths that became equal when their ends were left out.
void merge_equal(std::vector<PathSolution>& paths);
/// Choices at facing switches of the most probable path, from the probabilities of all.
void find_switches(const Map& map, JourneyResult& journey);
/// Stretches where other paths differ from the most probable one.
void find_ambiguous(JourneyResult& journey);

}  // namespace versine::georef
