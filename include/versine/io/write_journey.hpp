// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "versine/core/error.hpp"
#include "versine/network/source.hpp"
#include "versine/simulation/recording.hpp"

namespace versine::io {

/// Writes a recording in the OnboardEU layout (journey_onboard.hpp): group `journey_01` with `GNSS` and, where there is
/// an IMU, `IMU`; mean specific force and rate over each interval. Times are seconds of the recording's scale.
[[nodiscard]] Expected<void> write_onboard(const std::filesystem::path& path,
                                           const simulation::SimulatedRecording& recording);

/// Writes the tracks of a map as GeoJSON with the collection's `crs` member; connections and nodes are left out.
[[nodiscard]] Expected<void> write_network_geojson(const std::filesystem::path& path,
                                                   const network::NetworkSource& source);

}  // namespace versine::io
