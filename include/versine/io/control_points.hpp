// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/io/recording_description.hpp"
#include "versine/stationing/readings.hpp"

namespace versine::io {

/// A list of control points: CSV (docs/formats/total-station.md), LandXML CgPoints, or coordinates in a field book.
struct ControlFile {
  TableFile table;
  PositionFrame frame;    ///< `crs` of map coordinates; `origin` of north, east, up
  double sigma = 0.5e-3;  ///< of each coordinate, where the file gives none, m
};

/// A control point as listed.
struct ControlEntry {
  std::string name;
  geodesy::Geodetic position;
  Eigen::Vector3d sigma_ned = Eigen::Vector3d::Zero();
  std::size_t line = 0;
};

/// Reads the list. Fails on a point without name, a coordinate that is not a number, or map coordinates without `crs`.
[[nodiscard]] Expected<std::vector<ControlEntry>> read_control_points(const ControlFile& file);

/// CSV as `read_control_points` reads it, geographic coordinates.
[[nodiscard]] Expected<void> write_control_points(const std::filesystem::path& path,
                                                  std::span<const ControlEntry> points);

}  // namespace versine::io
