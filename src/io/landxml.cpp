// SPDX-License-Identifier: Apache-2.0
#include "versine/io/landxml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>

namespace versine::io {

namespace {

using design::Shape;

std::string metres(double value) {
  return fmt::format("{:.9f}", value);
}
std::string radius(double curvature) {
  return curvature == 0.0 ? "INF" : fmt::format("{:.15g}", std::abs(1.0 / curvature));
}

const char* type_of(Shape shape) {
  switch (shape) {
    case Shape::helmert:
      return "biquadratic";
    case Shape::bloss:
      return "bloss";
    case Shape::cosine:
      return "cosine";
    case Shape::sine:
      return "sinusoid";
    case Shape::viennese:
      return "weinerBogen";
    case Shape::cubic_parabola:
      return "cubicParabola";
    default:
      return "clothoid";
  }
}

/// Standard deviations as properties of a Feature: the schema's place for what other programs skip.
void add_sigma(pugi::xml_node node, std::initializer_list<std::pair<std::string, double>> values) {
  pugi::xml_node feature = node.child("Feature");
  if (!feature) {
    feature = node.append_child("Feature");
    feature.append_attribute("code") = "standard deviation";
    feature.append_attribute("source") = "Versine";
  }
  for (const auto& [label, value] : values) {
    if (!(value > 0.0)) continue;
    pugi::xml_node property = feature.append_child("Property");
    property.append_attribute("label") = label.c_str();
    property.append_attribute("value") = fmt::format("{:.6g}", value).c_str();
  }
}

void add_point(pugi::xml_node node, const char* name, double easting, double northing) {
  node.append_child(name).text().set((metres(northing) + " " + metres(easting)).c_str());
}

pugi::xml_node add_element(pugi::xml_node geometry, const design::HorizontalElement& e, const design::AxisPose& start,
                           const design::AxisPose& end, double station) {
  const bool line = e.shape == Shape::line, arc = e.shape == Shape::arc;
  pugi::xml_node node = geometry.append_child(line ? "Line" : arc ? "Curve" : "Spiral");
  if (!e.name.empty()) node.append_attribute("name") = e.name.c_str();
  node.append_attribute("length") = metres(e.length).c_str();
  node.append_attribute("staStart") = metres(station).c_str();
  const double k = e.curvature_start != 0.0 ? e.curvature_start : e.curvature_end;
  if (!line) node.append_attribute("rot") = k < 0.0 ? "ccw" : "cw";
  if (arc) node.append_attribute("radius") = radius(k).c_str();
  if (!line && !arc) {
    node.append_attribute("radiusStart") = radius(e.curvature_start).c_str();
    node.append_attribute("radiusEnd") = radius(e.curvature_end).c_str();
    node.append_attribute("spiType") = type_of(e.shape);
  }
  add_point(node, "Start", start.easting, start.northing);
  if (arc) {
    add_point(node, "Center", start.easting + std::cos(start.heading) / k,
              start.northing - std::sin(start.heading) / k);
  } else if (!line) {
    // Intersection of the end tangents.
    const double turn = end.heading - start.heading;
    const double e1 = end.easting - start.easting, n1 = end.northing - start.northing;
    const double t = std::abs(std::sin(turn)) < 1e-12
                         ? 0.5 * std::hypot(e1, n1)
                         : (e1 * std::cos(end.heading) - n1 * std::sin(end.heading)) / -std::sin(turn);
    add_point(node, "PI", start.easting + t * std::sin(start.heading), start.northing + t * std::cos(start.heading));
  }
  add_point(node, "End", end.easting, end.northing);
  return node;
}

/// `sigma`: one per element, or none at all.
Expected<void> add_horizontal(pugi::xml_node node, const design::Alignment& a,
                              std::span<const design::ElementSigma> sigma) {
  pugi::xml_node geometry = node.append_child("CoordGeom");
  for (std::size_t i = 0; i < a.horizontal.elements().size(); ++i) {
    const auto& placed = a.horizontal.elements()[i];
    const design::HorizontalElement& e = placed.element;
    const auto pose = [&](double u) { return a.horizontal.at(placed.distance + u, i); };
    if (!(e.curvature_start * e.curvature_end < 0.0)) {
      pugi::xml_node element = add_element(geometry, e, pose(0.0), pose(e.length), placed.distance);
      if (i < sigma.size()) {
        const design::ElementSigma& s = sigma[i];
        const bool arc = e.shape == Shape::arc;
        add_sigma(element, {{"start_m", s.joint},
                            {"length_m", s.length},
                            {"radius_m", arc ? s.curvature / std::pow(e.curvature_start, 2) : 0.0},
                            {"cant_m", design::is_transition(e.shape) ? 0.0 : s.cant}});
      }
      continue;
    }
    if (e.shape != Shape::clothoid) {
      return fail({.field = fmt::format("horizontal element {} ({})", i + 1, design::to_string(e.shape)),
                   .found = "a transition from right to left in one element",
                   .expected = "one direction: LandXML has no words for both",
                   .advice = "write it as two transitions that meet in a straight point"});
    }
    design::HorizontalElement first = e, second = e;
    first.length = e.length * e.curvature_start / (e.curvature_start - e.curvature_end);
    second.length = e.length - first.length;
    first.curvature_end = second.curvature_start = 0.0;
    add_element(geometry, first, pose(0.0), pose(first.length), placed.distance);
    add_element(geometry, second, pose(first.length), pose(e.length), placed.distance + first.length);
  }
  return {};
}

void add_profile(pugi::xml_node node, const design::Alignment& a, std::span<const design::GradientSigma> sigma) {
  if (a.profile.empty()) return;
  pugi::xml_node profile = node.append_child("Profile").append_child("ProfAlign");
  profile.append_attribute("name") = a.name.c_str();
  for (const design::VerticalPoint& p : a.profile.points()) {
    using Curve = design::VerticalPoint::Curve;
    const auto& elements = a.profile.elements();
    // The curve of this point is the element that holds it.
    const auto curve = std::find_if(elements.begin(), elements.end(), [&p](const design::VerticalElement& e) {
      return e.shape != design::VerticalElement::Shape::gradient && p.distance > e.distance &&
             p.distance < e.distance + e.length;
    });
    const bool rounded = p.curve != Curve::none && curve != elements.end();
    pugi::xml_node point = profile.append_child(!rounded                     ? "PVI"
                                                : p.curve == Curve::parabola ? "ParaCurve"
                                                                             : "CircCurve");
    if (rounded) {
      point.append_attribute("length") = metres(curve->length).c_str();
      if (p.curve == Curve::circle) {
        const auto sine = [](double g) { return g / std::sqrt(1.0 + g * g); };
        const double k = (sine(curve->gradient_end) - sine(curve->gradient_start)) / curve->length;
        point.append_attribute("radius") = fmt::format("{:.15g}", 1.0 / k).c_str();
      }
    }
    point.text().set((metres(p.distance) + " " + metres(p.height)).c_str());
  }
  // A point of the profile has no room for a Feature: the profile has them all.
  for (std::size_t i = 0; i < sigma.size(); ++i) {
    add_sigma(profile, {{fmt::format("gradient_{}", i + 1), sigma[i].gradient},
                        {fmt::format("station_{}_m", i + 1), sigma[i].place},
                        {fmt::format("curve_{}_m", i + 1), sigma[i].curve}});
  }
}

void add_cant(pugi::xml_node node, const design::Alignment& a) {
  if (a.cant.empty()) return;
  pugi::xml_node cant = node.append_child("Cant");
  cant.append_attribute("name") = a.name.c_str();
  cant.append_attribute("gauge") = "1.435";
  cant.append_attribute("rotationPoint") = "center";
  const auto& points = a.cant.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    // A point without cant takes the side that its ramp leads to.
    double side = points[i].cant;
    if (side == 0.0 && i + 1 < points.size()) side = points[i + 1].cant;
    if (side == 0.0 && i > 0) side = points[i - 1].cant;
    pugi::xml_node point = cant.append_child("CantStation");
    point.append_attribute("station") = metres(points[i].distance).c_str();
    point.append_attribute("appliedCant") = metres(side < 0.0 ? -points[i].cant : points[i].cant).c_str();
    point.append_attribute("curvature") = side < 0.0 ? "ccw" : "cw";
    point.append_attribute("transitionType") = type_of(points[i].ramp);
  }
}

void add_chainage(pugi::xml_node node, const design::Alignment& a) {
  double before = 0.0;
  const auto& equations = a.chainage.equations();
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const design::ChainageEquation& e = equations[i];
    pugi::xml_node equation = node.append_child("StaEquation");
    before = i == 0 ? e.mileage : e.mileage - a.chainage.jump(i);
    equation.append_attribute("staBack") = metres(before).c_str();
    equation.append_attribute("staAhead") = metres(e.mileage).c_str();
    equation.append_attribute("staInternal") = metres(e.distance).c_str();
    equation.append_attribute("staIncrement") = e.increasing ? "increasing" : "decreasing";
  }
}

Expected<void> write(const std::filesystem::path& path, std::span<const design::Alignment> alignments,
                     const design::OptimalAxis* axis) {
  pugi::xml_document doc;
  pugi::xml_node declaration = doc.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  pugi::xml_node root = doc.append_child("LandXML");
  root.append_attribute("xmlns") = "http://www.landxml.org/schema/LandXML-1.2";
  root.append_attribute("version") = "1.2";
  pugi::xml_node units = root.append_child("Units").append_child("Metric");
  for (const auto& [name, value] : {std::pair{"areaUnit", "squareMeter"},
                                    {"linearUnit", "meter"},
                                    {"volumeUnit", "cubicMeter"},
                                    {"temperatureUnit", "celsius"},
                                    {"pressureUnit", "HPA"},
                                    {"angularUnit", "radians"},
                                    {"directionUnit", "radians"}}) {
    units.append_attribute(name) = value;
  }
  if (!alignments.empty() && alignments[0].crs.rfind("EPSG:", 0) == 0) {
    root.append_child("CoordinateSystem").append_attribute("epsgCode") = alignments[0].crs.substr(5).c_str();
  }
  root.append_child("Application").append_attribute("name") = "Versine";
  pugi::xml_node group = root.append_child("Alignments");
  for (const design::Alignment& a : alignments) {
    pugi::xml_node node = group.append_child("Alignment");
    node.append_attribute("name") = a.name.c_str();
    node.append_attribute("length") = metres(a.length()).c_str();
    node.append_attribute("staStart") = metres(0.0).c_str();
    if (auto good = add_horizontal(node, a, axis != nullptr ? axis->sigma : std::vector<design::ElementSigma>());
        !good) {
      return good;
    }
    add_chainage(node, a);
    add_cant(node, a);
    add_profile(node, a, axis != nullptr ? axis->gradient_sigma : std::vector<design::GradientSigma>());
  }
  if (!doc.save_file(path.c_str(), "  ")) {
    return fail({.file = path.string(), .found = "it can't be written", .expected = "a writable place"});
  }
  return {};
}

}  // namespace

Expected<void> write_landxml(const std::filesystem::path& path, std::span<const design::Alignment> alignments) {
  return write(path, alignments, nullptr);
}

Expected<void> write_landxml(const std::filesystem::path& path, const design::OptimalAxis& axis) {
  return write(path, {&axis.alignment, 1}, &axis);
}

}  // namespace versine::io
