// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "versine/report/drawing.hpp"

namespace versine::report {

/// Lines and points in map metres, drawn north up with one scale for both directions, a bar of length and an arrow.
struct MapLine {
  std::vector<Point> points;  ///< easting, northing; NaN lifts the pen
  Pen pen;
  bool frames = true;  ///< counts for what the map shows
};
struct MapMark {
  Point at;
  std::string text;
  int severity = -1, severities = 0;  ///< a level's sign; -1: a small ring
  std::uint32_t colour = 0x1b1f24;
};
struct MapView {
  std::vector<MapLine> lines;
  std::vector<MapMark> marks;
  std::string caption;  ///< "EPSG:25832"
};

void draw_map(Drawing& d, const Box& box, const MapView& view);

}  // namespace versine::report
