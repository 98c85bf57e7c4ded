// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "versine/app/geometry_config.hpp"
#include "versine/io/run_json.hpp"
#include "versine/track/compute.hpp"

namespace versine::app {

/// How the result was tied to the project's grid and heights.
struct CoordinateTie {
  std::optional<geodesy::Similarity> similarity;
  geodesy::HeightDatum heights;
  std::vector<geodesy::HeightPoint> height_points;
};

/// Reads the common points and sets the similarity and heights of `input`. Nothing when the job wants neither. Fails
/// with fewer than two common points (three in space), naming what is missing.
[[nodiscard]] Expected<std::optional<CoordinateTie>> tie_coordinates(const CoordinatesConfig& config,
                                                                     track::GeometryInput& input,
                                                                     std::vector<io::RunInput>& files);

/// Residuals of every common point, mm, and those left out.
[[nodiscard]] Expected<void> write_tie(const std::filesystem::path& path, const CoordinateTie& tie);
[[nodiscard]] std::string tie_json(const CoordinateTie& tie);
[[nodiscard]] std::string tie_text(const CoordinateTie& tie);

}  // namespace versine::app
