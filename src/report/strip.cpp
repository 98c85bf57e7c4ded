// SPDX-License-Identifier: Apache-2.0
#include "versine/report/strip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "colours.hpp"
#include "versine/report/figure.hpp"

namespace versine::report {

namespace {

constexpr double bin = 0.35;   // mm, of a curve and its band
constexpr double least = 0.1;  // mm: a narrower band lies under its curve
using colours::ink, colours::muted;
constexpr std::uint32_t grid = 0xe3e7eb;

struct Scale {
  double from = 0.0, per = 1.0, origin = 0.0;
  double operator()(double v) const { return origin + (v - from) * per; }
};

struct Window {
  std::size_t first = 0, last = 0;  ///< of values
  Scale x, y;
  Box plot;
};

/// Lowest and highest value of each bin in their order; a bin without values lifts the pen.
std::vector<Point> thinned(const Window& w, const StripAxis& axis, std::span<const double> value) {
  std::vector<Point> out;
  std::size_t low = w.last, high = w.last;
  bool gap = true;
  long open = -1;
  const auto flush = [&] {
    if (low == w.last) return;
    const std::size_t a = std::min(low, high), b = std::max(low, high);
    out.push_back({w.x(axis.x[a]), w.y(value[a])});
    if (b != a) out.push_back({w.x(axis.x[b]), w.y(value[b])});
    low = high = w.last;
  };
  for (std::size_t i = w.first; i < w.last; ++i) {
    if (!std::isfinite(value[i])) {
      flush();
      if (!gap) out.push_back(pen_up);
      gap = true;
      continue;
    }
    const long now = static_cast<long>((w.x(axis.x[i]) - w.plot.x) / bin);
    if (now != open) flush();
    open = now;
    gap = false;
    if (low == w.last || value[i] < value[low]) low = i;
    if (high == w.last || value[i] > value[high]) high = i;
  }
  flush();
  return out;
}

/// In the bins of the curve: a wider bin would show the signal's own range as if it were uncertainty.
void draw_band(Drawing& d, const Window& w, const StripAxis& axis, const StripCurve& c) {
  std::vector<Point> upper, lower;
  const auto flush = [&] {
    if (upper.size() > 1) {
      upper.insert(upper.end(), lower.rbegin(), lower.rend());
      d.area(std::move(upper), {c.colour, 0.16});
    }
    upper.clear();
    lower.clear();
  };
  long open = -1;
  for (std::size_t i = w.first; i < w.last; ++i) {
    const double half = 1.96 * c.sigma[i];
    if (!(std::isfinite(c.value[i] + half) && half * std::abs(w.y.per) > least)) {
      flush();
      open = -1;
      continue;
    }
    const double x = w.x(axis.x[i]), top = w.y(c.value[i] + half), bottom = w.y(c.value[i] - half);
    const long now = static_cast<long>((x - w.plot.x) / bin);
    if (now != open) {
      upper.push_back({x, top});
      lower.push_back({x, bottom});
    } else {
      upper.back().y = std::min(upper.back().y, top);
      lower.back().y = std::max(lower.back().y, bottom);
    }
    open = now;
  }
  flush();
}

void draw_limits(Drawing& d, const Strip& s, const Window& w) {
  for (const StripLimit& l : s.limits) {
    if (!(l.value > s.low) || !(l.value < s.high)) continue;
    const Dash dash = l.severity + 1 == l.severities   ? Dash::solid
                      : l.severity + 2 == l.severities ? Dash::dashed
                                                       : Dash::dotted;
    d.line({w.plot.x, w.y(l.value)}, {w.plot.right(), w.y(l.value)},
           {level_colour(l.severity, l.severities), 0.18, dash});
  }
}

void draw_scale(Drawing& d, const Strip& s, const Window& w) {
  const int count = std::clamp(static_cast<int>(w.plot.height / 4.5), 2, 6);
  for (const double t : ticks(s.low, s.high, count)) {
    const double y = w.y(t);
    if (y < w.plot.y + 0.5 || y > w.plot.bottom() - 0.5) continue;
    d.line({w.plot.x, y}, {w.plot.right(), y}, {std::abs(t) < 1e-12 ? 0xb4bcc4 : grid, 0.12, Dash::solid});
    d.text({w.plot.x - 0.9, y + 0.75}, fmt::format("{:g}", std::abs(t) < 1e-12 ? 0.0 : t),
           {.size = 2.05, .anchor = Anchor::end, .colour = muted});
  }
}

void draw_names(Drawing& d, const Strip& s, const Box& row) {
  const double room = strip_left - 9.0;
  double y = row.y + 3.2;
  for (const std::string& line : wrapped(s.name, room, 2.5, true)) {
    if (y > row.bottom()) return;
    d.text({row.x, y}, line, {.size = 2.5, .bold = true});
    y += 3.0;
  }
  for (const std::string& line : wrapped(s.detail, room, 2.0)) {
    if (y > row.bottom()) return;
    d.text({row.x, y}, line, {.size = 2.0, .colour = muted});
    y += 2.6;
  }
}

void draw_extremes(Drawing& d, const Strip& s, const Window& w) {
  if (s.curves.empty()) return;
  const StripCurve& c = s.curves.front();
  double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0.0;
  std::size_t n = 0;
  for (std::size_t i = w.first; i < w.last; ++i) {
    if (!std::isfinite(c.value[i])) continue;
    low = std::min(low, c.value[i]);
    high = std::max(high, c.value[i]);
    if (c.sigma.empty() || !std::isfinite(c.sigma[i])) continue;
    sum += c.sigma[i];
    ++n;
  }
  const double x = w.plot.right() + strip_right;
  if (!(low <= high)) {
    d.text({x, w.plot.y + 3.2}, "\xE2\x80\x93", {.size = 2.3, .anchor = Anchor::end, .colour = muted});
    return;
  }
  const TextStyle number{.size = 2.3, .anchor = Anchor::end, .colour = ink};
  const TextStyle small{.size = 2.0, .anchor = Anchor::end, .colour = muted};
  d.text({x, w.plot.y + 3.2}, "max " + decimal(high, s.decimals), number);
  d.text({x, w.plot.y + 6.4}, "min " + decimal(low, s.decimals), number);
  if (n > 0 && w.plot.height > 9.5) {
    d.text({x, w.plot.y + 9.4}, "\xCF\x83 " + decimal(sum / static_cast<double>(n), s.decimals + 1), small);
  }
}

void draw_marks(Drawing& d, const Strip& s, const Window& w, const StripAxis& axis) {
  for (const StripMark& m : s.marks) {
    if (m.to < axis.from || m.from > axis.to) continue;
    const double a = w.x(std::max(m.from, axis.from)), b = std::max(a + 0.35, w.x(std::min(m.to, axis.to)));
    d.rectangle({a, w.plot.y, b - a, w.plot.height}, Fill{level_colour(m.severity, m.severities), 0.18});
  }
  for (const StripMark& m : s.marks) {
    if (m.x < axis.from || m.x > axis.to) continue;
    draw_level_mark(d, {w.x(m.x), w.plot.bottom() - 1.1}, 0.85, m.severity, m.severities);
  }
}

void draw_strip(Drawing& d, const Box& row, const Strip& s, const StripAxis& axis, bool extremes) {
  Window w;
  w.plot = {row.x + strip_left, row.y, row.width - strip_left - (extremes ? strip_right : 0.0), row.height};
  w.x = {axis.from, w.plot.width / axis.span, w.plot.x};
  w.y = {s.low, -(w.plot.height - 1.6) / (s.high - s.low), w.plot.bottom() - 0.8};
  w.first = static_cast<std::size_t>(std::lower_bound(axis.x.begin(), axis.x.end(), axis.from - 1e-6) - axis.x.begin());
  w.last = static_cast<std::size_t>(std::upper_bound(axis.x.begin(), axis.x.end(), axis.to + 1e-6) - axis.x.begin());
  d.begin(Group{"img", s.name + ", " + s.detail, {}});
  draw_names(d, s, row);
  draw_scale(d, s, w);
  d.begin(Clip{w.plot});
  draw_limits(d, s, w);
  draw_marks(d, s, w, axis);
  for (const StripCurve& c : s.curves) {
    if (!c.sigma.empty()) draw_band(d, w, axis, c);
  }
  for (const StripCurve& c : s.curves) {
    auto points = thinned(w, axis, c.value);
    if (!points.empty()) d.polyline(std::move(points), {c.colour, 0.2, c.dash});
  }
  d.end();
  if (extremes) draw_extremes(d, s, w);
  d.end();
  d.line({row.x, row.bottom()}, {row.right(), row.bottom()}, {0xc9d1d9, 0.15, Dash::solid});
}

/// Places below the strips, at round posted mileages, and chainage jumps as double lines.
void draw_axis(Drawing& d, const Box& plot, const StripAxis& axis) {
  const double per = plot.width / axis.span;
  const auto at = [&](double s) { return plot.x + (s - axis.from) * per; };
  const auto steps = ticks(0.0, axis.span, 10);
  const double step = steps.size() > 1 ? steps[1] - steps[0] : axis.span;
  // Round mileages are sought by walking: chainage may jump or run backwards.
  double last = -1e9;
  const double walk = step / 100.0;
  for (double s = axis.from; s <= axis.to + 1e-6; s += walk) {
    const double p = axis.posted(s), k = std::round(p / step);
    if (std::abs(p - k * step) > 0.5 * walk + 1e-9) continue;
    const double place = s + (axis.posted(s + 0.01) >= p ? k * step - p : p - k * step), x = at(place);
    if (x - last < 15.0 || x > plot.right() + 0.1) continue;
    last = x;
    d.line({x, plot.y}, {x, plot.bottom()}, {0xeceff2, 0.12, Dash::solid});
    d.line({x, plot.bottom()}, {x, plot.bottom() + 1.0}, {muted, 0.15, Dash::solid});
    d.text({x, plot.bottom() + 3.6}, axis.label(place), {.size = 2.3, .anchor = Anchor::middle, .colour = ink});
  }
  for (const auto& jump : axis.jumps) {
    if (jump.at < axis.from || jump.at > axis.to) continue;
    for (const double shift : {-0.35, 0.35}) {
      d.line({at(jump.at) + shift, plot.y}, {at(jump.at) + shift, plot.bottom() + 4.2}, {ink, 0.18, Dash::solid});
    }
    d.text({at(jump.at) + 1.0, plot.bottom() + 6.4}, jump.text,
           {.size = 2.2, .anchor = at(jump.at) > plot.right() - 45.0 ? Anchor::end : Anchor::start, .bold = true});
  }
}

}  // namespace

std::string decimal(double value, int decimals) {
  if (!std::isfinite(value)) return "";
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::uint32_t level_colour(int severity, int severities) {
  if (severity + 1 >= severities) return colours::bad;
  return severity + 2 >= severities ? 0xc25e00 : 0xb58900;
}

void draw_level_mark(Drawing& d, Point c, double r, int severity, int severities) {
  const Fill fill{level_colour(severity, severities), 1.0};
  const Pen rim{0xffffff, 0.15, Dash::solid};
  if (severity + 1 >= severities) {
    d.area({{c.x - r, c.y - r}, {c.x + r, c.y - r}, {c.x + r, c.y + r}, {c.x - r, c.y + r}}, fill, rim);
  } else if (severity + 2 >= severities) {
    d.area({{c.x, c.y - 1.3 * r}, {c.x + 1.3 * r, c.y}, {c.x, c.y + 1.3 * r}, {c.x - 1.3 * r, c.y}}, fill, rim);
  } else {
    d.area({{c.x, c.y - 1.2 * r}, {c.x + 1.2 * r, c.y + r}, {c.x - 1.2 * r, c.y + r}}, fill, rim);
  }
}

void fit_scale(Strip& s) {
  if (s.low < s.high) return;
  double low = 0.0, high = 0.0;
  for (const StripCurve& c : s.curves) {
    for (const double v : c.value) {
      if (!std::isfinite(v)) continue;
      low = std::min(low, v);
      high = std::max(high, v);
    }
  }
  // The band is seen whole where it is not wider than the curve itself.
  for (const StripCurve& c : s.curves) {
    double sum = 0.0, n = 0.0;
    for (const double v : c.sigma) {
      if (std::isfinite(v)) sum += v, n += 1.0;
    }
    const double half = n > 0.0 ? std::min(1.96 * sum / n, std::max(-low, high)) : 0.0;
    low -= half;
    high += half;
  }
  const double reach = std::max({-low, high, 1e-3});
  for (const StripLimit& l : s.limits) {
    if (l.value > 0.0 && l.value < 2.0 * reach) high = std::max(high, l.value);
    if (l.value < 0.0 && -l.value < 2.0 * reach) low = std::min(low, l.value);
  }
  const double range = std::max(high - low, 1e-3);
  s.low = low - 0.12 * range;
  s.high = high + 0.08 * range;
}

void fit_to_data(Strip& s) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const StripCurve& c : s.curves) {
    for (const double v : c.value) {
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
    }
  }
  if (!(low <= high)) low = high = 0.0;
  const double room = std::max(0.1 * (high - low), 1e-4 + 1e-9 * std::abs(high));
  s.low = low - room;
  s.high = high + room;
}

void draw_strips(Drawing& d, const Box& box, std::span<const Strip> strips, const StripAxis& axis, bool extremes) {
  if (strips.empty() || !(axis.span > 0.0)) return;
  const double foot = axis.jumps.empty() ? 5.5 : 7.5;
  const double height = (box.height - foot) / static_cast<double>(strips.size());
  const Box plot{box.x + strip_left, box.y, box.width - strip_left - (extremes ? strip_right : 0.0), box.height - foot};
  draw_axis(d, plot, axis);
  double y = box.y;
  for (const Strip& s : strips) {
    draw_strip(d, {box.x, y, box.width, height}, s, axis, extremes);
    y += height;
  }
  d.line({box.x, box.y}, {box.right(), box.y}, {0xc9d1d9, 0.15, Dash::solid});
}

}  // namespace versine::report
