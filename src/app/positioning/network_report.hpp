// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "versine/geodesy/local_frame.hpp"
#include "versine/stationing/network_adjustment.hpp"

/// A network adjustment in files: for the stationing job and for a survey.
namespace versine::app {

/// Adjusted points, their offsets from the coordinates given, and which of them have moved.
Expected<void> write_network_points(const std::filesystem::path& path, const geodesy::LocalFrame& frame,
                                    const stationing::NetworkResult& network);

/// sigma0, redundancy, number of points, names of those that have moved.
std::string network_summary_json(const stationing::NetworkResult& network);

}  // namespace versine::app
