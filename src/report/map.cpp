// SPDX-License-Identifier: Apache-2.0
#include "versine/report/map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "colours.hpp"
#include "versine/report/figure.hpp"
#include "versine/report/strip.hpp"

namespace versine::report {

namespace {

using colours::muted;

struct Frame {
  double low_x = std::numeric_limits<double>::infinity(), high_x = -low_x;
  double low_y = low_x, high_y = -low_x;
  void add(const Point& p) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
    low_x = std::min(low_x, p.x);
    high_x = std::max(high_x, p.x);
    low_y = std::min(low_y, p.y);
    high_y = std::max(high_y, p.y);
  }
};

/// Points nearer than a tenth of a millimetre on the paper are left out.
std::vector<Point> thinned(std::vector<Point> points) {
  std::vector<Point> out;
  for (const Point& p : points) {
    const bool up = !std::isfinite(p.x);
    if (!out.empty() && !up && std::isfinite(out.back().x) &&
        std::hypot(p.x - out.back().x, p.y - out.back().y) < 0.1) {
      continue;
    }
    if (up && (out.empty() || !std::isfinite(out.back().x))) continue;
    out.push_back(p);
  }
  return out;
}

/// Longest round length that fits a quarter of the map.
double bar_length(double metres) {
  double length = std::pow(10.0, std::floor(std::log10(metres)));
  for (const double m : {5.0, 2.0}) {
    if (m * length <= metres) return m * length;
  }
  return length;
}

void draw_furniture(Drawing& d, const Box& box, double per_metre, const std::string& caption) {
  const double length = bar_length(0.25 * box.width / per_metre), x = box.right() - 3.0, y = box.bottom() - 3.0;
  d.line({x - length * per_metre, y}, {x, y}, {colours::ink, 0.4, Dash::solid});
  d.text({x, y - 1.2}, length >= 1000.0 ? fmt::format("{:g} km", length / 1000.0) : fmt::format("{:g} m", length),
         {.size = 2.3, .anchor = Anchor::end});
  d.area({{x - 2.0, box.y + 3.0}, {x - 0.7, box.y + 7.5}, {x - 2.0, box.y + 6.6}, {x - 3.3, box.y + 7.5}},
         {muted, 1.0});
  d.text({x - 2.0, box.y + 10.2}, "N", {.size = 2.3, .anchor = Anchor::middle, .colour = muted});
  d.text({box.x + 1.5, box.bottom() - 1.5}, fitted(caption, box.width - 0.3 * box.width, 2.0),
         {.size = 2.0, .colour = muted});
}

}  // namespace

void draw_map(Drawing& d, const Box& box, const MapView& view) {
  Frame frame;
  for (const MapLine& line : view.lines) {
    if (!line.frames) continue;
    for (const Point& p : line.points) frame.add(p);
  }
  for (const MapMark& mark : view.marks) frame.add(mark.at);
  d.rectangle(box, Fill{0xfbfcfd}, Pen{colours::rule, 0.2, Dash::solid});
  if (!(frame.low_x <= frame.high_x)) return;
  const double margin = 7.0;
  const double width = std::max(frame.high_x - frame.low_x, 1.0), height = std::max(frame.high_y - frame.low_y, 1.0);
  const double per = std::min((box.width - 2.0 * margin) / width, (box.height - 2.0 * margin) / height);
  const double cx = 0.5 * (frame.low_x + frame.high_x), cy = 0.5 * (frame.low_y + frame.high_y);
  const auto place = [&](const Point& p) {
    return Point{box.x + 0.5 * box.width + (p.x - cx) * per, box.y + 0.5 * box.height - (p.y - cy) * per};
  };
  d.begin(Group{"img", view.caption, {}});
  d.begin(Clip{box});
  for (const MapLine& line : view.lines) {
    std::vector<Point> points;
    points.reserve(line.points.size());
    for (const Point& p : line.points) points.push_back(place(p));
    d.polyline(thinned(std::move(points)), line.pen);
  }
  for (const MapMark& mark : view.marks) {
    const Point p = place(mark.at);
    if (mark.severity >= 0) {
      draw_level_mark(d, p, 1.1, mark.severity, mark.severities);
    } else {
      d.circle(p, 0.8, Fill{0xffffff}, Pen{mark.colour, 0.3, Dash::solid});
    }
    const bool far_right = p.x > box.right() - 14.0;
    if (!mark.text.empty()) {
      d.text({p.x + (far_right ? -1.6 : 1.6), p.y - 1.2}, mark.text,
             {.size = 2.3, .anchor = far_right ? Anchor::end : Anchor::start, .colour = mark.colour});
    }
  }
  d.end();
  d.end();
  draw_furniture(d, box, per, view.caption);
}

}  // namespace versine::report
