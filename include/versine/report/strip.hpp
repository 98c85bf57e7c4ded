// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "versine/report/drawing.hpp"

/// Strips: quantities over the distance, one below the other, with their sigmas, limits and exceedances.
namespace versine::report {

/// One curve. NaN is a gap. The vectors belong to the caller and outlive the drawing of the strip.
struct StripCurve {
  std::span<const double> value;
  std::vector<double> sigma;  ///< same unit; empty: none is drawn
  std::uint32_t colour = 0x0b5fa5;
  Dash dash = Dash::solid;
};

struct StripLimit {
  double value = 0.0;
  int severity = 0;  ///< 0 the mildest
  int severities = 1;
  std::string level;
};

struct StripMark {
  double x = 0.0, from = 0.0, to = 0.0;
  int severity = 0, severities = 1;
};

struct Strip {
  std::string name;    ///< "Gauge"
  std::string detail;  ///< "minus 1435 mm, mm"
  std::vector<StripCurve> curves;
  std::vector<StripLimit> limits;
  std::vector<StripMark> marks;
  double low = 0.0, high = 0.0;  ///< of the scale; equal: from the data, zero included
  int decimals = 1;              ///< of the numbers beside it
};

/// The stretch that is drawn, and how places are told.
struct StripAxis {
  std::span<const double> x;                 ///< continuous distance of every value, m, increasing
  double from = 0.0, to = 0.0;               ///< m
  double span = 0.0;                         ///< m of the whole width; longer than to - from on the last page
  std::function<std::string(double)> label;  ///< "12+400" of a continuous distance
  std::function<double(double)> posted;      ///< posted mileage of a continuous distance
  struct Jump {
    double at = 0.0;   ///< m
    std::string text;  ///< "18+215 = 18+200, -15 m"
  };
  std::vector<Jump> jumps;
};

/// Widths of the labels left of the strips and the numbers right of them, mm.
inline constexpr double strip_left = 37.0, strip_right = 22.0;

/// Colour and sign of a level: the severest red and a square, the next orange and a diamond, others yellow triangles.
[[nodiscard]] std::uint32_t level_colour(int severity, int severities);
void draw_level_mark(Drawing& d, Point centre, double size, int severity, int severities);

/// Sets low and high so that the data fit, and limits within reach of them are seen.
void fit_scale(Strip& strip);
/// The same for heights and angles, whose zero means nothing: the data fill the strip.
void fit_to_data(Strip& strip);

/// Draws strips that share the height of the box, the axis of places below them. Curves are thinned to the lowest and
/// highest value in each 0.35 mm. `extremes` writes smallest, largest value and mean sigma right of each strip.
void draw_strips(Drawing& d, const Box& box, std::span<const Strip> strips, const StripAxis& axis,
                 bool extremes = true);

/// Text of a number with so many decimals, without "-0.0"; a true minus sign is not used, so that texts can be
/// searched.
[[nodiscard]] std::string decimal(double value, int decimals);

}  // namespace versine::report
