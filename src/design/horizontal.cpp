// SPDX-License-Identifier: Apache-2.0
#include "versine/design/horizontal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

namespace versine::design {

namespace {

/// In the element's own frame: forward and right of its start, heading against its start.
struct Local {
  double forward = 0.0, right = 0.0, heading = 0.0, curvature = 0.0, curvature_rate = 0.0;
};

Local on_arc(double k, double u) {
  const double phi = k * u;
  // u sin(phi)/phi and u (1 - cos phi)/phi, exact for small angles too.
  const double half = 0.5 * phi;
  const double sinc = std::abs(half) < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  return {u * sinc * std::cos(half), u * sinc * std::sin(half), phi, k, 0.0};
}

/// Heading against the start, without curvature: all that the quadrature needs.
double heading_at(const HorizontalElement& e, double u) {
  const double xi = u / e.length;
  double phi = e.curvature_start * u + (e.curvature_end - e.curvature_start) * e.length * ramp_integral(e.shape, xi);
  if (e.shape == Shape::viennese) {
    const double p = xi * (1.0 - xi);
    phi -= 140.0 * e.cant_term / e.length * p * p * p;
  }
  return phi;
}

void add_panel(const HorizontalElement& e, double from, double to, Local& sum) {
  const auto& node = boost::math::quadrature::gauss<double, 10>::abscissa();
  const auto& weight = boost::math::quadrature::gauss<double, 10>::weights();
  const double mid = 0.5 * (from + to), half = 0.5 * (to - from);
  double c = 0.0, s = 0.0;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const double a = heading_at(e, mid - half * node[i]), b = heading_at(e, mid + half * node[i]);
    c += weight[i] * (std::cos(a) + std::cos(b));
    s += weight[i] * (std::sin(a) + std::sin(b));
  }
  sum.forward += half * c;
  sum.right += half * s;
}

Local on_transition(const HorizontalElement& e, double u) {
  Local out;
  const double xi = u / e.length, dk = e.curvature_end - e.curvature_start;
  // Ten nodes hold 1e-10 m while the heading turns by less than a quarter of a radian per panel.
  const double turn = std::max(std::abs(e.curvature_start), std::abs(e.curvature_end)) * u;
  const int panels = 1 + static_cast<int>(std::min(turn / 0.25, 1000.0));
  // Helmert's two parabolas meet at the middle; no panel may cross it.
  const double middle = 0.5 * e.length;
  const bool split = e.shape == Shape::helmert && u > middle;
  const double first_end = split ? middle : u;
  for (int i = 0; i < panels; ++i) add_panel(e, first_end * i / panels, first_end * (i + 1) / panels, out);
  for (int i = 0; split && i < panels; ++i) {
    add_panel(e, middle + (u - middle) * i / panels, middle + (u - middle) * (i + 1) / panels, out);
  }
  out.heading = heading_at(e, u);
  out.curvature = e.curvature_start + dk * ramp(e.shape, xi);
  out.curvature_rate = dk / e.length * ramp_rate(e.shape, xi);
  if (e.shape == Shape::viennese) {
    const double scale = -420.0 * e.cant_term / (e.length * e.length);
    out.curvature += scale * xi * xi * (1.0 + xi * (-4.0 + xi * (5.0 - 2.0 * xi)));
    out.curvature_rate += scale / e.length * xi * (2.0 + xi * (-12.0 + xi * (20.0 - 10.0 * xi)));
  }
  return out;
}

/// Arc length of y = c x^3 / 6 between two abscissae.
double cubic_length(double c, double from, double to) {
  return boost::math::quadrature::gauss<double, 10>::integrate(
      [c](double x) { return std::hypot(1.0, 0.5 * c * x * x); }, from, to);
}

/// y = c x^3 / 6 with c = (k2 - k1) / length, from the abscissa where its second derivative is k1.
Local on_cubic(const HorizontalElement& e, double u) {
  const double c = (e.curvature_end - e.curvature_start) / e.length;
  if (c == 0.0) return on_arc(e.curvature_start, u);
  const double x1 = e.curvature_start / c;
  const double slope1 = 0.5 * c * x1 * x1, angle1 = std::atan(slope1);
  double x = x1 + u;
  for (int i = 0; i < 20; ++i) {  // Newton; the slope is small, so it converges in three or four steps
    const double step = (cubic_length(c, x1, x) - u) / std::hypot(1.0, 0.5 * c * x * x);
    x -= step;
    if (std::abs(step) < 1e-12 * e.length) break;
  }
  const double slope = 0.5 * c * x * x, q = 1.0 + slope * slope;
  const double dx = x - x1, dy = c / 6.0 * (x * x * x - x1 * x1 * x1);
  const double cos1 = std::cos(angle1), sin1 = std::sin(angle1);
  const double root = std::sqrt(q);
  return {dx * cos1 + dy * sin1, dy * cos1 - dx * sin1, std::atan(slope) - angle1, c * x / (q * root),
          (c * q - 3.0 * c * c * x * x * slope) / (q * q * root * root)};
}

Local evaluate(const HorizontalElement& e, double u) {
  switch (e.shape) {
    case Shape::line:
      return {u, 0.0, 0.0, 0.0, 0.0};
    case Shape::arc:
      return on_arc(e.curvature_start, u);
    case Shape::cubic_parabola:
      return on_cubic(e, u);
    default:
      return on_transition(e, u);
  }
}

AxisPose placed(const Local& p, const MapPose& start, double scale = 1.0) {
  const double c = scale * std::cos(start.heading), s = scale * std::sin(start.heading);
  AxisPose out;
  out.easting = start.easting + s * p.forward + c * p.right;
  out.northing = start.northing + c * p.forward - s * p.right;
  out.heading = start.heading + p.heading;
  out.curvature = p.curvature;
  out.curvature_rate = p.curvature_rate;
  return out;
}

AxisPose beyond(AxisPose p, double distance) {
  p.easting += distance * std::sin(p.heading);
  p.northing += distance * std::cos(p.heading);
  p.curvature = p.curvature_rate = 0.0;
  return p;
}

Expected<void> check(const HorizontalElement& e, std::size_t index) {
  const bool lengths = e.length > 0.0 && std::isfinite(e.length);
  const bool curvatures =
      std::isfinite(e.curvature_start) && std::isfinite(e.curvature_end) && std::isfinite(e.cant_term);
  const bool constant = is_transition(e.shape) || e.curvature_start == e.curvature_end;
  const bool straight = e.shape != Shape::line || e.curvature_start == 0.0;
  if (lengths && curvatures && constant && straight) return {};
  return fail(
      {.field = fmt::format("horizontal element {} ({}{}{})", index + 1, to_string(e.shape), e.name.empty() ? "" : " ",
                            e.name),
       .found = fmt::format("length {} m, curvature {} to {} 1/m", e.length, e.curvature_start, e.curvature_end),
       .expected = !lengths      ? "a positive length"
                   : !curvatures ? "finite curvatures"
                   : !straight   ? "no curvature on a line"
                                 : "one radius on an arc",
       .advice = "mend the element in the design, or leave it out"});
}

}  // namespace

HorizontalElement line(double length) {
  return {.shape = Shape::line, .length = length};
}

HorizontalElement arc(double length, double radius) {
  return {.shape = Shape::arc, .length = length, .curvature_start = 1.0 / radius, .curvature_end = 1.0 / radius};
}

HorizontalElement transition(Shape shape, double length, double radius_start, double radius_end) {
  return {.shape = shape, .length = length, .curvature_start = 1.0 / radius_start, .curvature_end = 1.0 / radius_end};
}

AxisPose pose_on(const HorizontalElement& element, const MapPose& start, double u) {
  return placed(evaluate(element, u), start);
}

Expected<HorizontalAxis> HorizontalAxis::chain(const MapPose& start, std::vector<HorizontalElement> elements) {
  HorizontalAxis axis;
  MapPose pose = start;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (auto good = check(elements[i], i); !good) return tl::unexpected(good.error());
    const double length = elements[i].length;
    axis.elements_.push_back({std::move(elements[i]), pose, axis.length_, 1.0});
    pose = pose_on(axis.elements_.back().element, pose, length);
    axis.length_ += length;
  }
  if (axis.elements_.empty() || !std::isfinite(pose.easting) || !std::isfinite(pose.northing)) {
    return fail({.field = "horizontal alignment",
                 .found = axis.elements_.empty() ? "no element" : "no finite start",
                 .expected = "at least one element, starting at a finite easting, northing and heading"});
  }
  return axis;
}

Expected<HorizontalAxis> HorizontalAxis::place(std::vector<Placed> elements) {
  HorizontalAxis axis;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (auto good = check(elements[i].element, i); !good) return tl::unexpected(good.error());
    elements[i].distance = axis.length_;
    axis.length_ += elements[i].element.length;
  }
  if (elements.empty()) {
    return fail({.field = "horizontal alignment", .found = "no element", .expected = "at least one element"});
  }
  axis.elements_ = std::move(elements);
  return axis;
}

std::size_t HorizontalAxis::element_at(double distance) const {
  const auto after = std::upper_bound(elements_.begin() + 1, elements_.end(), distance,
                                      [](double d, const Placed& p) { return d < p.distance; });
  return static_cast<std::size_t>(after - elements_.begin()) - 1;
}

AxisPose HorizontalAxis::at(double distance, std::size_t element) const {
  const Placed& p = elements_[element];
  return placed(evaluate(p.element, std::clamp(distance - p.distance, 0.0, p.element.length)), p.start, p.scale);
}

AxisPose HorizontalAxis::end() const {
  return at(length_, elements_.size() - 1);
}

AxisPose HorizontalAxis::at(double distance) const {
  if (distance < 0.0) return beyond(at(0.0, 0), distance);
  if (distance > length_) return beyond(end(), distance - length_);
  return at(distance, element_at(distance));
}

}  // namespace versine::design
