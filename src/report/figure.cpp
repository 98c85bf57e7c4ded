// SPDX-License-Identifier: Apache-2.0
#include "versine/report/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace versine::report {

namespace {

/// Okabe and Ito's palette: told apart by colour-blind readers too.
constexpr std::array palette{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"};
constexpr int left = 64, right = 16, top = 34, bottom = 48;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// Values to pixels along one axis.
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

void draw_axes(std::string& svg, const Figure& f, const Scale& x, const Scale& y, int axis_bottom) {
  svg += "<g stroke=\"#ddd\" stroke-width=\"1\">";
  for (const double t : axis_ticks(x, 7)) {
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}\"/>", x(t), y.from, y.to);
  }
  for (const double t : axis_ticks(y, 6)) {
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\"/>", x.from, y(t), x.to);
  }
  svg += "</g><g font-size=\"11\" fill=\"#333\">";
  for (const double t : axis_ticks(x, 7)) {
    svg +=
        fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", x(t), y.from + 15, number(t));
  }
  for (const double t : axis_ticks(y, 6)) {
    svg +=
        fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", x.from - 6, y(t) + 4, number(t));
  }
  svg += fmt::format(
      "</g><rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" stroke=\"#333\"/>", x.from,
      y.to, x.to - x.from, y.from - y.to);
  svg += fmt::format("<text x=\"{}\" y=\"20\" font-size=\"13\" font-weight=\"bold\" text-anchor=\"middle\">{}</text>",
                     f.width / 2, escaped(f.title));
  svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" font-size=\"12\" text-anchor=\"middle\">{}</text>",
                     0.5 * (x.from + x.to), axis_bottom - 12, escaped(f.x.label));
  svg += fmt::format(
      "<text transform=\"translate(15 {:.1f}) rotate(-90)\" font-size=\"12\" text-anchor=\"middle\">{}</text>",
      0.5 * (y.from + y.to), escaped(f.y.label));
}

/// White over yellow and orange to red, the share of the range from 0 to 1.
std::string heat(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return fmt::format("rgb({:.0f},{:.0f},{:.0f})", 255 - 55 * u * u, 250 - 170 * u, 225 - 175 * std::sqrt(u));
}

void draw_field(std::string& svg, const Field& f, const Scale& x, const Scale& y) {
  const auto [low, high] = std::minmax_element(f.value.begin(), f.value.end());
  const double range = *high > *low ? *high - *low : 1.0;
  svg += "<g shape-rendering=\"crispEdges\">";
  for (std::size_t j = 0; j + 1 < f.y.size(); ++j) {
    for (std::size_t i = 0; i + 1 < f.x.size(); ++i) {
      const double v = 0.25 * (f.value[j * f.x.size() + i] + f.value[j * f.x.size() + i + 1] +
                               f.value[(j + 1) * f.x.size() + i] + f.value[(j + 1) * f.x.size() + i + 1]);
      svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>", x(f.x[i]),
                         y(f.y[j + 1]), x(f.x[i + 1]) - x(f.x[i]) + 0.1, y(f.y[j]) - y(f.y[j + 1]) + 0.1,
                         heat((v - *low) / range));
    }
  }
  svg += "</g>";
  const auto draw = [&](double level, const char* style) {
    std::string path;
    double label_x = 0.0, label_y = 0.0;
    for (const Segment& s : contour(f, level)) {
      path += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", x(s.x1), y(s.y1), x(s.x2), y(s.y2));
      if (x(s.x1) > label_x) label_x = x(s.x1), label_y = y(s.y1);
    }
    if (path.empty()) return;
    svg += fmt::format("<path d=\"{}\" fill=\"none\" {}/>", path, style);
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"10\" text-anchor=\"end\">{}</text>", label_x - 2,
                       label_y - 3, number(level));
  };
  for (const double level : f.contours) draw(level, "stroke=\"#555\" stroke-width=\"0.8\"");
  if (f.emphasis) draw(*f.emphasis, "stroke=\"#000\" stroke-width=\"2.2\"");
}

const char* colour_of(const Curve& c, std::size_t index) {
  const std::size_t k = c.colour >= 0 ? static_cast<std::size_t>(c.colour) : index;
  return palette[k % palette.size()];
}

void draw_curve(std::string& svg, const Curve& c, const char* colour, const Scale& x, const Scale& y) {
  const std::size_t n = std::min(c.x.size(), c.y.size());
  if (c.style == CurveStyle::points) {
    svg += fmt::format("<g fill=\"{}\">", colour);
    for (std::size_t i = 0; i < n; ++i) {
      if (std::isfinite(c.y[i]))
        svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\"/>", x(c.x[i]), y(c.y[i]));
    }
    svg += "</g>";
    return;
  }
  if (c.style == CurveStyle::bars) {
    const double width = n > 1 ? 0.9 * std::abs(x(c.x[1]) - x(c.x[0])) : 10.0;
    svg += fmt::format("<g fill=\"{}\" fill-opacity=\"0.55\">", colour);
    for (std::size_t i = 0; i < n; ++i) {
      svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>",
                         x(c.x[i]) - 0.5 * width, y(c.y[i]), width, std::max(0.0, y.from - y(c.y[i])));
    }
    svg += "</g>";
    return;
  }
  std::string path;
  bool pen_down = false;
  for (std::size_t i = 0; i < n; ++i) {
    const bool drawable = std::isfinite(c.y[i]) && (!y.logarithmic || c.y[i] > 0.0) && (!x.logarithmic || c.x[i] > 0.0);
    if (drawable) path += fmt::format("{}{:.1f} {:.1f}", pen_down ? 'L' : 'M', x(c.x[i]), y(c.y[i]));
    pen_down = drawable;
  }
  svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\"{}/>", path, colour,
                     c.style == CurveStyle::dashed ? " stroke-dasharray=\"6 4\"" : "");
}

struct LegendEntry {
  std::string name, mark;  ///< mark: SVG drawn at the origin, 22 px wide
};

std::vector<LegendEntry> legend(const Figure& f) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < f.curves.size(); ++i) {
    const Curve& c = f.curves[i];
    if (c.name.empty()) continue;
    const char* colour = colour_of(c, i);
    switch (c.style) {
      case CurveStyle::points:
        entries.push_back({c.name, fmt::format("<circle cx=\"11\" r=\"2.5\" fill=\"{}\"/>", colour)});
        break;
      case CurveStyle::bars:
        entries.push_back(
            {c.name,
             fmt::format("<rect y=\"-5\" width=\"22\" height=\"10\" fill=\"{}\" fill-opacity=\"0.55\"/>", colour)});
        break;
      case CurveStyle::line:
      case CurveStyle::dashed:
        entries.push_back({c.name, fmt::format("<path d=\"M0 0h22\" stroke=\"{}\" stroke-width=\"2\"{}/>", colour,
                                               c.style == CurveStyle::dashed ? " stroke-dasharray=\"6 4\"" : "")});
    }
  }
  if (f.field && f.field->emphasis && !f.field->label.empty()) {
    entries.push_back({f.field->label, "<path d=\"M0 0h22\" stroke=\"#000\" stroke-width=\"2.2\"/>"});
  }
  return entries;
}

/// Where each entry of the legend lies below the plot, in rows; the last pair is the number of rows.
std::vector<std::pair<double, int>> legend_places(const std::vector<LegendEntry>& entries, double width) {
  std::vector<std::pair<double, int>> places;
  double x = 0.0;
  int row = 0;
  for (const auto& e : entries) {
    const double needed = 42.0 + 6.2 * static_cast<double>(e.name.size());
    if (x > 0.0 && x + needed > width) {
      x = 0.0;
      ++row;
    }
    places.emplace_back(x, row);
    x += needed;
  }
  places.emplace_back(0.0, entries.empty() ? 0 : row + 1);
  return places;
}

constexpr int legend_row = 17;  // px

std::string body(const Figure& f) {
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
  const Scale x = make_scale(ax, ex, left, f.width - right, false);
  const auto entries = legend(f);
  const auto places = legend_places(entries, x.to - x.from);
  const int axis_bottom = f.height - legend_row * places.back().second;
  const Scale y = make_scale(f.y, ey, axis_bottom - bottom, top, from_zero);
  std::string svg = "<g font-family=\"sans-serif\">";
  if (f.field) draw_field(svg, *f.field, x, y);
  draw_axes(svg, f, x, y, axis_bottom);
  for (std::size_t i = 0; i < f.curves.size(); ++i) draw_curve(svg, f.curves[i], colour_of(f.curves[i], i), x, y);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    svg += fmt::format("<g transform=\"translate({:.1f} {})\">{}<text x=\"28\" y=\"4\" font-size=\"11\">{}</text></g>",
                       x.from + places[i].first, axis_bottom + legend_row * places[i].second + 2, entries[i].mark,
                       escaped(entries[i].name));
  }
  return svg + "</g>";
}

std::string document(int width, int height, const std::string& content) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\">"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>{2}</svg>\n",
      width, height, content);
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

std::string to_svg(const Figure& figure) {
  return document(figure.width, figure.height, body(figure));
}

std::string to_svg(std::span<const Figure> panels, int columns) {
  std::string content;
  int x = 0, y = 0, row_height = 0, width = 0, in_row = 0;
  for (const Figure& f : panels) {
    if (in_row == columns) {
      y += row_height;
      x = row_height = in_row = 0;
    }
    content += fmt::format("<g transform=\"translate({} {})\">{}</g>", x, y, body(f));
    x += f.width;
    width = std::max(width, x);
    row_height = std::max(row_height, f.height);
    ++in_row;
  }
  return document(width, y + row_height, content);
}

}  // namespace versine::report
