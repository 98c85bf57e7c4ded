// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/sensors/measurements.hpp"

namespace versine::io {

/// GNSS positions as `read_gnss` reads them back: 11 decimals of a degree (1 um), sigmas to 0.01 mm.
[[nodiscard]] Expected<void> write_gnss_csv(const std::filesystem::path& path, const Series<sensors::GnssSample>& gnss);

/// Landmarks as `read_landmarks` reads them back; positions and their sigmas, not the attitude.
[[nodiscard]] Expected<void> write_landmarks_csv(const std::filesystem::path& path,
                                                 const std::vector<sensors::LandmarkSample>& landmarks);

}  // namespace versine::io
