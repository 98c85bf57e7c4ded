// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "versine/report/drawing.hpp"

/// Scientific figures : axes, curves, bars, maps with contours, a legend. Drawn on a page of a report, or as an SVG
/// file of their own.
namespace versine::report {

struct Axis {
  std::string label;                ///< with unit: "distance, m"
  std::optional<double> low, high;  ///< none: from the data, rounded to ticks
  bool logarithmic = false;
};

enum class CurveStyle { line, dashed, points, bars };

struct Curve {
  std::string name;          ///< in the legend; empty: not there
  std::vector<double> x, y;  ///< a NaN breaks a line
  CurveStyle style = CurveStyle::line;
  int colour = -1;  ///< index into the palette; -1: the next
};

/// A quantity over a grid, drawn as coloured cells under contour lines.
struct Field {
  std::vector<double> x, y;        ///< ascending
  std::vector<double> value;       ///< row by row: value[iy * x.size() + ix]
  std::vector<double> contours;    ///< thin lines, labelled in the legend when few
  std::optional<double> emphasis;  ///< one thick line: a requirement
  std::string label;               ///< of the emphasised line
};

struct Figure {
  std::string title;
  Axis x, y;
  std::vector<Curve> curves;
  std::optional<Field> field;
  double width = 169.0, height = 106.0;  ///< mm, of a file of its own
};

void draw(Drawing& drawing, const Box& box, const Figure& figure);
[[nodiscard]] std::string to_svg(const Figure& figure);
/// Several figures in one picture, row by row. REQUIRES columns > 0.
[[nodiscard]] std::string to_svg(std::span<const Figure> panels, int columns);

/// Lines of equal value by marching squares, with linear interpolation on the cells' edges: pairs of points.
struct Segment {
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0;
};
[[nodiscard]] std::vector<Segment> contour(const Field& field, double level);

/// Round values that divide [low, high] into about `count` parts (1, 2 or 5 times a power of ten).
[[nodiscard]] std::vector<double> ticks(double low, double high, int count);

}  // namespace versine::report
