// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/georef/georeference.hpp"

namespace versine::io {

/// Results in the order of a job's recordings; null where there is none. Layout: docs/formats-georef.md.
using GeorefResults = std::vector<const georef::RecordingResult*>;

/// Every grid step of every plausible path: /recording_N/journey_N/path_N/{distance_m, speed_mps, sigma_distance_m,
/// sigma_speed_mps}, its residuals, and attributes probability, log_likelihood, log_prior, tracks.
[[nodiscard]] Expected<void> write_georef_hdf5(const std::filesystem::path& path, const georef::Map& map,
                                               const GeorefResults& results);
/// GeoPackage in the network's projection, whose `wkt` is given because a projection is for one thread at a time: layer
/// `positions` (points every `interval` s of the most probable paths) and layer `paths` (a line for each plausible
/// path).
[[nodiscard]] Expected<void> write_georef_gpkg(const std::filesystem::path& path, const georef::Map& map,
                                               const std::string& wkt, const GeorefResults& results, double interval);
/// Loads the library that the GeoPackage is written with (40 ms, from any thread): what else there is to do meanwhile
/// hides it. May be left out.
void prepare_georef_gpkg();

}  // namespace versine::io
