// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "landxml_parts.hpp"
#include "versine/core/numbers.hpp"

namespace versine::io::detail {

using design::Shape;
using Verdict = design::AuditFinding::Verdict;

namespace {

bool finite(const design::MapPosition& p) {
  return std::isfinite(p.easting) && std::isfinite(p.northing);
}
double apart(const design::MapPosition& a, const design::MapPosition& b) {
  return std::hypot(b.easting - a.easting, b.northing - a.northing);
}

double curvature_of(const pugi::xml_node& node, const char* name, double metre) {
  const double radius = attribute(node, name) * metre;
  if (std::isnan(radius)) return nan;
  return std::isinf(radius) || radius == 0.0 ? 0.0 : 1.0 / radius;
}

/// Length of an arc from its points when the file does not state it.
double arc_length(const design::MapPosition& a, const design::MapPosition& b, const design::MapPosition& centre,
                  double radius, double turn) {
  const auto azimuth = [&](const design::MapPosition& p) {
    return std::atan2(p.easting - centre.easting, p.northing - centre.northing);
  };
  if (!finite(centre)) return 2.0 * radius * std::asin(std::min(1.0, apart(a, b) / (2.0 * radius)));
  double angle = std::fmod(turn * (azimuth(b) - azimuth(a)), 2.0 * std::acos(-1.0));
  if (angle < 0.0) angle += 2.0 * std::acos(-1.0);
  return radius * angle;
}

Expected<design::RawElement> read_element(const LandXmlDocument& doc, const pugi::xml_node& node, std::size_t index) {
  design::RawElement raw;
  raw.where = doc.where(node, index);
  raw.element.name = trimmed(node.attribute("name").value());
  raw.start = doc.position(node.child("Start"));
  raw.end = doc.position(node.child("End"));
  const auto refuse = [&](std::string found, std::string expected) {
    return fail({.file = doc.file,
                 .line = doc.line(node),
                 .field = raw.where,
                 .found = std::move(found),
                 .expected = std::move(expected),
                 .advice = "mend the element in the design software and export again"});
  };
  if (!finite(raw.start) || !finite(*raw.end)) return refuse("no readable Start or End", "northing and easting");
  const std::string kind = node.name(), rotation = node.attribute("rot").value();
  const double turn = rotation == "ccw" ? -1.0 : 1.0;
  if (kind != "Line" && rotation != "cw" && rotation != "ccw") return refuse("rot '" + rotation + "'", "cw or ccw");
  design::HorizontalElement& e = raw.element;
  e.length = attribute(node, "length") * doc.metre;
  if (kind == "Line") {
    e.shape = Shape::line;
    if (std::isnan(e.length)) e.length = apart(raw.start, *raw.end);
  } else if (kind == "Curve") {
    const design::MapPosition centre = doc.position(node.child("Center"));
    double radius = attribute(node, "radius") * doc.metre;
    if (std::isnan(radius)) radius = apart(centre, raw.start);
    if (!(radius > 0.0)) return refuse("radius " + std::string(node.attribute("radius").value()), "a positive radius");
    e.shape = Shape::arc;
    e.curvature_start = e.curvature_end = turn / radius;
    if (std::isnan(e.length)) e.length = arc_length(raw.start, *raw.end, centre, radius, turn);
  } else {
    const std::string type = node.attribute("spiType").value();
    const auto shape = shape_of(type);
    if (!shape)
      return refuse("spiType '" + type + "'",
                    "clothoid, biquadratic, bloss, cosine, sinusoid, sineHalfWave, "
                    "weinerBogen, cubic or cubicParabola");
    e.shape = *shape;
    e.curvature_start = turn * curvature_of(node, "radiusStart", doc.metre);
    e.curvature_end = turn * curvature_of(node, "radiusEnd", doc.metre);
  }
  return raw;
}

}  // namespace

Expected<void> read_horizontal(const LandXmlDocument& doc, const pugi::xml_node& alignment, design::RawAlignment& raw) {
  std::size_t index = 0;
  for (const pugi::xml_node& node : alignment.child("CoordGeom").children()) {
    const std::string kind = node.name();
    if (kind == "IrregularLine" || kind == "Chain") {
      return fail({.file = doc.file,
                   .line = doc.line(node),
                   .field = fmt::format("{} {}", kind, index + 1),
                   .found = "an element without radius and length",
                   .expected = "Line, Curve or Spiral",
                   .advice = "export the design geometry, not a polyline"});
    }
    if (kind != "Line" && kind != "Curve" && kind != "Spiral") continue;
    auto element = read_element(doc, node, ++index);
    if (!element) return tl::unexpected(element.error());
    // Design programs leave elements of no length where a station was set.
    if (element->element.length == 0.0) {
      raw.findings.push_back(
          {Verdict::healed, "element without length", element->where, 0.0, 0.0, 0.0, "m", "left out"});
      continue;
    }
    raw.elements.push_back(*std::move(element));
  }
  return {};
}

}  // namespace versine::io::detail
