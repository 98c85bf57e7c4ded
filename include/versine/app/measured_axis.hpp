// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "versine/design/optimal_axis.hpp"
#include "versine/track/geometry.hpp"

namespace versine::app {

/// The measured track axis every metre, as the optimal axis wants it; points without coordinates are left out.
[[nodiscard]] std::vector<design::TrackSample> axis_samples(const track::Geometry& geometry);

/// `versine axis`: the optimal axis of a result that holds geometry.csv.
struct AxisRequest {
  std::filesystem::path result;  ///< folder of a survey or geometry result
  std::filesystem::path output;  ///< LandXML to write; the table of elements with sigmas goes beside it, as .csv
  design::OptimalAxisOptions options;
};
struct AxisRun {
  design::OptimalAxis axis;
  std::filesystem::path landxml, table;
  std::string text;  ///< for a person
};
/// Fails when the result has no geometry.csv, or too little of it.
[[nodiscard]] Expected<AxisRun> run_axis(const AxisRequest& request);

}  // namespace versine::app
