// SPDX-License-Identifier: Apache-2.0
#include "versine/report/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "versine/report/svg.hpp"

namespace versine::report {

namespace {

/// Okabe and Ito's palette: told apart by colour-blind readers too.
constexpr std::array<std::uint32_t, 7> palette{0x0072B2, 0xD55E00, 0x009E73, 0xCC79A7, 0xE69F00, 0x56B4E9, 0x000000};
constexpr double left = 17.0, right = 4.5, top = 9.0, bottom = 12.5, legend_row = 4.6;  // mm
constexpr std::uint32_t frame = 0x333333, lattice = 0xdddddd;

/// Values to millimetres along one axis.
struct Scale {
  double low = 0.0, high = 1.0, from = 0.0, to = 1.0;
  bool logarithmic = false;
  [[nodiscard]] double operator()(double value) const {
    const double u = logarithmic ? (std::log(value) - std::log(low)) / (std::log(high) - std::log(low))
                                 : (value - low) / (high - low);
    return from + u * (to - from);
  }
};

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(std::span<const double> values, bool positive_only) {
    for (const double v : values) {
      if (!std::isfinite(v) || (positive_only && !(v > 0.0))) continue;
      low = std::min(low, v);
      high = std::max(high, v);
    }
  }
};

Scale make_scale(const Axis& axis, Extent data, double from, double to, bool from_zero) {
  if (!(data.low <= data.high)) data = {0.0, 1.0};
  if (from_zero && !axis.logarithmic) data.low = std::min(0.0, data.low);
  if (!axis.logarithmic && !axis.high) {
    const auto t = ticks(data.low, data.high, 6);
    const double step = t.size() > 1 ? t[1] - t[0] : 1.0;
    data.high = step * std::ceil(data.high / step - 1e-9);
    data.low = step * std::floor(data.low / step + 1e-9);
  }
  Scale s{axis.low.value_or(data.low), axis.high.value_or(data.high), from, to, axis.logarithmic};
  if (!(s.high > s.low)) s.high = s.low + (s.low == 0.0 ? 1.0 : std::abs(s.low));
  return s;
}

std::vector<double> axis_ticks(const Scale& s, int count) {
  if (!s.logarithmic) return ticks(s.low, s.high, count);
  std::vector<double> t;
  const bool decades_only = s.high / s.low > 2e3;  // more labels would run into each other
  for (double p = std::pow(10.0, std::floor(std::log10(s.low))); p <= s.high * 1.0001; p *= 10.0) {
    for (const double m : {1.0, 2.0, 5.0}) {
      if (decades_only && m > 1.0) break;
      if (m * p >= s.low * 0.9999 && m * p <= s.high * 1.0001) t.push_back(m * p);
    }
  }
  return t;
}

std::string number(double x) {
  return fmt::format("{:.6g}", std::abs(x) < 1e-12 ? 0.0 : x);
}

void draw_axes(Drawing& d, const Box& box, const Figure& f, const Scale& x, const Scale& y, double axis_bottom) {
  const auto xs = axis_ticks(x, 7), ys = axis_ticks(y, 6);
  for (const double t : xs) d.line({x(t), y.from}, {x(t), y.to}, {lattice, 0.2, Dash::solid});
  for (const double t : ys) d.line({x.from, y(t)}, {x.to, y(t)}, {lattice, 0.2, Dash::solid});
  for (const double t : xs) d.text({x(t), y.from + 4.0}, number(t), {.size = 2.9, .anchor = Anchor::middle});
  for (const double t : ys) d.text({x.from - 1.5, y(t) + 1.0}, number(t), {.size = 2.9, .anchor = Anchor::end});
  d.rectangle({x.from, y.to, x.to - x.from, y.from - y.to}, {}, Pen{frame, 0.25, Dash::solid});
  d.text({box.x + 0.5 * box.width, box.y + 5.3}, f.title, {.size = 3.4, .anchor = Anchor::middle, .bold = true});
  d.text({0.5 * (x.from + x.to), axis_bottom - 3.2}, f.x.label, {.size = 3.1, .anchor = Anchor::middle});
  d.text({box.x + 4.0, 0.5 * (y.from + y.to)}, f.y.label, {.size = 3.1, .anchor = Anchor::middle, .upright = false});
}

/// White over yellow and orange to red, the share of the range from 0 to 1.
std::uint32_t heat(double u) {
  u = std::clamp(u, 0.0, 1.0);
  const auto part = [](double v) { return static_cast<std::uint32_t>(std::lround(std::clamp(v, 0.0, 255.0))); };
  return part(255 - 55 * u * u) << 16 | part(250 - 170 * u) << 8 | part(225 - 175 * std::sqrt(u));
}

void draw_level(Drawing& d, const Field& f, double level, Pen pen, const Scale& x, const Scale& y) {
  Path path{.pen = pen};
  Point label;
  for (const Segment& s : contour(f, level)) {
    const Point a{x(s.x1), y(s.y1)}, b{x(s.x2), y(s.y2)};
    path.points.insert(path.points.end(), {a, b, pen_up});
    if (a.x > label.x) label = a;
  }
  if (path.points.empty()) return;
  d.items.emplace_back(std::move(path));
  d.text({label.x - 0.5, label.y - 0.8}, number(level), {.size = 2.6, .anchor = Anchor::end});
}

void draw_field(Drawing& d, const Field& f, const Scale& x, const Scale& y) {
  const auto [low, high] = std::minmax_element(f.value.begin(), f.value.end());
  const double range = *high > *low ? *high - *low : 1.0;
  const std::size_t nx = f.x.size();
  for (std::size_t j = 0; j + 1 < f.y.size(); ++j) {
    for (std::size_t i = 0; i + 1 < nx; ++i) {
      const double v = 0.25 * (f.value[j * nx + i] + f.value[j * nx + i + 1] + f.value[(j + 1) * nx + i] +
                               f.value[(j + 1) * nx + i + 1]);
      // A little wider than the cell: no hairlines between neighbours.
      d.rectangle({x(f.x[i]), y(f.y[j + 1]), x(f.x[i + 1]) - x(f.x[i]) + 0.03, y(f.y[j]) - y(f.y[j + 1]) + 0.03},
                  Fill{heat((v - *low) / range)});
    }
  }
  for (const double level : f.contours) draw_level(d, f, level, {0x555555, 0.2, Dash::solid}, x, y);
  if (f.emphasis) draw_level(d, f, *f.emphasis, {0x000000, 0.6, Dash::solid}, x, y);
}

std::uint32_t colour_of(const Curve& c, std::size_t index) {
  const std::size_t k = c.colour >= 0 ? static_cast<std::size_t>(c.colour) : index;
  return palette[k % palette.size()];
}

void draw_curve(Drawing& d, const Curve& c, std::uint32_t colour, const Scale& x, const Scale& y) {
  const std::size_t n = std::min(c.x.size(), c.y.size());
  if (c.style == CurveStyle::points) {
    for (std::size_t i = 0; i < n; ++i) {
      if (std::isfinite(c.y[i])) d.circle({x(c.x[i]), y(c.y[i])}, 0.7, Fill{colour});
    }
    return;
  }
  if (c.style == CurveStyle::bars) {
    const double width = n > 1 ? 0.9 * std::abs(x(c.x[1]) - x(c.x[0])) : 3.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double height = y.from - y(c.y[i]);
      if (height > 0.0) d.rectangle({x(c.x[i]) - 0.5 * width, y(c.y[i]), width, height}, Fill{colour, 0.55});
    }
    return;
  }
  std::vector<Point> points;
  for (std::size_t i = 0; i < n; ++i) {
    const bool drawable = std::isfinite(c.y[i]) && (!y.logarithmic || c.y[i] > 0.0) && (!x.logarithmic || c.x[i] > 0.0);
    points.push_back(drawable ? Point{x(c.x[i]), y(c.y[i])} : pen_up);
  }
  d.polyline(std::move(points), {colour, 0.45, c.style == CurveStyle::dashed ? Dash::dashed : Dash::solid});
}

struct LegendEntry {
  std::string name;
  CurveStyle style = CurveStyle::line;
  std::uint32_t colour = 0;
  double x = 0.0;  ///< mm
  int row = 0;
};

void draw_sample(Drawing& d, Point at, const LegendEntry& e) {
  switch (e.style) {
    case CurveStyle::points:
      d.circle({at.x + 2.9, at.y}, 0.7, Fill{e.colour});
      break;
    case CurveStyle::bars:
      d.rectangle({at.x, at.y - 1.3, 5.8, 2.6}, Fill{e.colour, 0.55});
      break;
    case CurveStyle::line:
    case CurveStyle::dashed:
      d.line(at, {at.x + 5.8, at.y}, {e.colour, 0.5, e.style == CurveStyle::dashed ? Dash::dashed : Dash::solid});
  }
}

/// Entries in rows below the plot; the second is the number of rows.
std::pair<std::vector<LegendEntry>, int> legend(const Figure& f, double width) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < f.curves.size(); ++i) {
    const Curve& c = f.curves[i];
    if (!c.name.empty()) entries.push_back({c.name, c.style, colour_of(c, i)});
  }
  if (f.field && f.field->emphasis && !f.field->label.empty()) entries.push_back({f.field->label});
  double x = 0.0;
  int row = 0;
  for (LegendEntry& e : entries) {
    const double needed = 11.0 + text_width(e.name, 2.9);
    if (x > 0.0 && x + needed > width) {
      x = 0.0;
      ++row;
    }
    e.x = x;
    e.row = row;
    x += needed;
  }
  const int rows = entries.empty() ? 0 : row + 1;
  return {std::move(entries), rows};
}

}  // namespace

std::vector<double> ticks(double low, double high, int count) {
  const double range = high - low;
  if (!(range > 0.0) || !std::isfinite(range)) return {low};
  const double raw = range / count, power = std::pow(10.0, std::floor(std::log10(raw)));
  const double m = raw / power, step = power * (m < 1.5 ? 1.0 : m < 3.5 ? 2.0 : m < 7.5 ? 5.0 : 10.0);
  std::vector<double> t;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) t.push_back(k * step);
  return t;
}

std::vector<Segment> contour(const Field& f, double level) {
  std::vector<Segment> segments;
  const std::size_t nx = f.x.size();
  for (std::size_t j = 0; j + 1 < f.y.size(); ++j) {
    for (std::size_t i = 0; i + 1 < nx; ++i) {
      // Corners counter-clockwise, and where the level crosses each edge.
      const double cx[] = {f.x[i], f.x[i + 1], f.x[i + 1], f.x[i]}, cy[] = {f.y[j], f.y[j], f.y[j + 1], f.y[j + 1]};
      const double v[] = {f.value[j * nx + i], f.value[j * nx + i + 1], f.value[(j + 1) * nx + i + 1],
                          f.value[(j + 1) * nx + i]};
      std::array<std::pair<double, double>, 4> cut;
      int cuts = 0;
      for (int e = 0; e < 4; ++e) {
        const int g = (e + 1) % 4;
        if ((v[e] < level) == (v[g] < level)) continue;
        const double u = (level - v[e]) / (v[g] - v[e]);
        cut[static_cast<std::size_t>(cuts++)] = {cx[e] + u * (cx[g] - cx[e]), cy[e] + u * (cy[g] - cy[e])};
      }
      for (int k = 0; k + 1 < cuts; k += 2) {
        const auto &a = cut[static_cast<std::size_t>(k)], &b = cut[static_cast<std::size_t>(k) + 1];
        segments.push_back({a.first, a.second, b.first, b.second});
      }
    }
  }
  return segments;
}

void draw(Drawing& d, const Box& box, const Figure& f) {
  Extent ex, ey;
  bool from_zero = false;
  for (const auto& c : f.curves) {
    ex.add(c.x, f.x.logarithmic);
    ey.add(c.y, f.y.logarithmic);
    from_zero |= c.style == CurveStyle::bars;
  }
  if (f.field) {
    ex.add(f.field->x, f.x.logarithmic);
    ey.add(f.field->y, f.y.logarithmic);
  }
  Axis ax = f.x;
  if (std::isfinite(ex.low)) {  // the data fill the width
    ax.low = ax.low.value_or(ex.low);
    ax.high = ax.high.value_or(ex.high);
  }
  const Scale x = make_scale(ax, ex, box.x + left, box.right() - right, false);
  const auto [entries, rows] = legend(f, x.to - x.from);
  const double axis_bottom = box.bottom() - legend_row * rows;
  const Scale y = make_scale(f.y, ey, axis_bottom - bottom, box.y + top, from_zero);
  d.begin(Group{"img", f.title, {}});
  if (f.field) draw_field(d, *f.field, x, y);
  draw_axes(d, box, f, x, y, axis_bottom);
  d.begin(Clip{{x.from, y.to, x.to - x.from, y.from - y.to}});
  for (std::size_t i = 0; i < f.curves.size(); ++i) draw_curve(d, f.curves[i], colour_of(f.curves[i], i), x, y);
  d.end();
  for (const LegendEntry& e : entries) {
    const Point at{x.from + e.x, axis_bottom + legend_row * e.row + 0.5};
    draw_sample(d, at, e);
    d.text({at.x + 7.4, at.y + 1.0}, e.name, {.size = 2.9});
  }
  d.end();
}

std::string to_svg(const Figure& figure) {
  return to_svg(std::span(&figure, 1), 1);
}

std::string to_svg(std::span<const Figure> panels, int columns) {
  Drawing d{.width = 0.0, .height = 0.0};
  Box box;
  int in_row = 0;
  for (const Figure& f : panels) {
    if (in_row == columns) {
      box.x = 0.0;
      box.y = d.height;
      in_row = 0;
    }
    box.width = f.width;
    box.height = f.height;
    draw(d, box, f);
    box.x += f.width;
    d.width = std::max(d.width, box.x);
    d.height = std::max(d.height, box.bottom());
    ++in_row;
  }
  return to_svg(d, true);
}

}  // namespace versine::report
