// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>

namespace versine::app {

/// Compares two georeferencings of the same recordings, as the page's journeys: each of `journeys` gets the most
/// probable path of the journey of that recording in `others` that shares most time with it (`other`; null when there
/// is none), and `differs`: where the two are on different tracks, with `fromM` and `toM` on its own path, its tracks
/// there
/// (`here`) and the other's (`there`).
void add_difference(nlohmann::ordered_json& journeys, const nlohmann::ordered_json& others);

}  // namespace versine::app
