// SPDX-License-Identifier: Apache-2.0
// What LandXML gives by station: profile, cant, chainage.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "landxml_parts.hpp"
#include "versine/core/numbers.hpp"

namespace versine::io::detail {

using design::Shape;
using Verdict = design::AuditFinding::Verdict;

namespace {

/// An unsymmetrical parabola is two symmetrical ones; the gradient where they meet follows from their intersections.
void add_unsymmetrical(const design::VerticalPoint& p, double in, double out, double g1, double g2,
                       std::vector<design::VerticalPoint>& points) {
  points.push_back({p.distance - 0.5 * in, p.height - g1 * 0.5 * in, design::VerticalPoint::Curve::parabola, in});
  points.push_back({p.distance + 0.5 * out, p.height + g2 * 0.5 * out, design::VerticalPoint::Curve::parabola, out});
}

}  // namespace

void read_profile(const LandXmlDocument& doc, const pugi::xml_node& alignment, double start,
                  design::RawAlignment& raw) {
  const auto profiles = alignment.child("Profile").children("ProfAlign");
  const auto count = std::distance(profiles.begin(), profiles.end());
  if (count == 0) return;
  if (count > 1) {
    raw.findings.push_back({Verdict::noted, "several profiles", "", 0.0, static_cast<double>(count), 0.0, "",
                            "the first is used: " + trimmed(profiles.begin()->attribute("name").value())});
  }
  using Curve = design::VerticalPoint::Curve;
  struct Read {
    design::VerticalPoint point;
    double in = 0.0, out = 0.0;  // of an unsymmetrical parabola
    double stated = 0.0;         // length of a circle that also has a radius
  };
  std::vector<Read> read;
  for (const pugi::xml_node& node : profiles.begin()->children()) {
    const std::string kind = node.name();
    if (kind != "PVI" && kind != "ParaCurve" && kind != "UnsymParaCurve" && kind != "CircCurve") continue;
    const std::vector<double> v = numbers(node.child_value());
    Read r;
    r.point.distance = v.size() > 1 ? v[0] * doc.metre - start : nan;
    r.point.height = v.size() > 1 ? v[1] * doc.metre : nan;
    r.point.name = fmt::format("line {}", doc.line(node));
    if (kind == "ParaCurve") {
      r.point.length = attribute(node, "length") * doc.metre;
      r.point.curve = r.point.length > 0.0 ? Curve::parabola : Curve::none;
    } else if (kind == "CircCurve") {
      // The radius defines the circle; files differ in what they call its length. A negative radius is a crest.
      r.point.radius = std::abs(attribute(node, "radius")) * doc.metre;
      r.stated = attribute(node, "length") * doc.metre;
      if (!(r.point.radius > 0.0)) r.point.length = r.stated;
      r.point.curve = Curve::circle;
    } else if (kind == "UnsymParaCurve") {
      r.in = attribute(node, "lengthIn") * doc.metre;
      r.out = attribute(node, "lengthOut") * doc.metre;
    }
    read.push_back(std::move(r));
  }
  const auto gradient = [&](std::size_t a, std::size_t b) {
    return (read[b].point.height - read[a].point.height) / (read[b].point.distance - read[a].point.distance);
  };
  for (std::size_t i = 1; i + 1 < read.size(); ++i) {
    design::VerticalPoint& p = read[i].point;
    const double follows = p.radius * std::abs(gradient(i, i + 1) - gradient(i - 1, i));
    if (!(p.radius > 0.0) || !(read[i].stated > 0.0) || std::abs(follows - read[i].stated) <= 0.01 * follows + 0.01) {
      continue;
    }
    raw.findings.push_back({Verdict::noted, "profile curve", p.name, p.distance, follows - read[i].stated, 0.0, "m",
                            fmt::format("its radius makes it {:.3f} m long, its length says {:.3f} m, which is used",
                                        follows, read[i].stated)});
    p.length = read[i].stated;
  }
  for (std::size_t i = 0; i < read.size(); ++i) {
    if (read[i].in > 0.0 && read[i].out > 0.0 && i > 0 && i + 1 < read.size()) {
      add_unsymmetrical(read[i].point, read[i].in, read[i].out, gradient(i - 1, i), gradient(i, i + 1), raw.profile);
    } else {
      raw.profile.push_back(read[i].point);
    }
  }
}

void read_cant(const LandXmlDocument& doc, const pugi::xml_node& alignment, double start, design::RawAlignment& raw) {
  double largest = 0.0;
  for (const pugi::xml_node& node : alignment.child("Cant").children("CantStation")) {
    const double cant = attribute(node, "appliedCant");
    // Cant is given as the outer rail's; "cw" is a right-hand curve, whose outer rail is the left one.
    const double sign = std::string(node.attribute("curvature").value()) == "ccw" ? -1.0 : 1.0;
    const Shape ramp = shape_of(node.attribute("transitionType").value()).value_or(Shape::clothoid);
    raw.cant.push_back({attribute(node, "station") * doc.metre - start, sign * cant, ramp});
    if (std::isfinite(cant)) largest = std::max(largest, std::abs(cant));
  }
  // No track has a metre of cant, and none is canted by a millimetre at most: the size tells the unit.
  const bool millimetres = largest > 1.0;
  for (design::CantPoint& p : raw.cant) p.cant *= millimetres ? 1e-3 : doc.metre;
  if (millimetres) {
    raw.findings.push_back({Verdict::noted, "cant in millimetres", "", 0.0, largest, 0.0, "mm",
                            "recognised by its size; LandXML asks for the file's unit of length"});
  }
}

void read_chainage(const LandXmlDocument& doc, const pugi::xml_node& alignment, double start,
                   design::RawAlignment& raw) {
  std::vector<design::ChainageEquation> equations;
  for (const pugi::xml_node& node : alignment.children("StaEquation")) {
    const std::string post = trimmed(node.attribute("desc").value());
    double internal = attribute(node, "staInternal") * doc.metre, ahead = attribute(node, "staAhead") * doc.metre;
    // Inframodel states kilometre posts: the kilometre's number is the description, its place the internal station.
    const bool posts = ahead == internal && !post.empty() && std::isfinite(number(post));
    if (posts) ahead = 1000.0 * number(post);
    const bool decreasing = std::string(node.attribute("staIncrement").value()) == "decreasing";
    equations.push_back({internal - start, ahead, !decreasing, posts ? "km post " + post : "StaEquation " + post});
  }
  std::stable_sort(equations.begin(), equations.end(),
                   [](const auto& a, const auto& b) { return a.distance < b.distance; });
  if (equations.empty() || equations.front().distance > 0.0) {
    equations.insert(equations.begin(), {0.0, start, true, "start"});
  }
  raw.chainage = std::move(equations);
}

}  // namespace versine::io::detail
