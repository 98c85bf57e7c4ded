// SPDX-License-Identifier: Apache-2.0
#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <pugixml.hpp>
#include <sstream>

#include "versine/io/landxml.hpp"

namespace versine::io {

namespace {

using design::Shape;
using Verdict = design::AuditFinding::Verdict;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// NaN when the text is no number. "INF" and "NaN" are words of LandXML.
double number(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n+");
  if (first == std::string_view::npos) return nan;
  text.remove_prefix(first);
  double value = nan;
  const auto [end, error] = fast_float::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view rest(end, static_cast<std::size_t>(text.data() + text.size() - end));
  return error == std::errc() && rest.find_first_not_of(" \t\r\n") == std::string_view::npos ? value : nan;
}

double attribute(const pugi::xml_node& node, const char* name) {
  return number(node.attribute(name).value());
}

std::vector<double> numbers(const std::string& text) {
  std::istringstream words(text);
  std::vector<double> values;
  for (std::string word; words >> word;) values.push_back(number(word));
  return values;
}

std::string trimmed(const std::string& text) {
  const auto a = text.find_first_not_of(" \t\r\n"), b = text.find_last_not_of(" \t\r\n");
  return a == std::string::npos ? "" : text.substr(a, b - a + 1);
}

/// The document with what every alignment in it needs.
struct Document {
  std::string file, text, crs;
  double metre = 1.0;  // per unit of length
  pugi::xml_document xml;
  std::map<std::string, design::MapPosition> points;  // CgPoint by name

  [[nodiscard]] std::size_t line(const pugi::xml_node& node) const {
    const auto at = std::clamp<std::ptrdiff_t>(node.offset_debug(), 0, static_cast<std::ptrdiff_t>(text.size()));
    return 1 + static_cast<std::size_t>(std::count(text.begin(), text.begin() + at, '\n'));
  }
  [[nodiscard]] std::string where(const pugi::xml_node& node, std::size_t index) const {
    const std::string name = trimmed(node.attribute("name").value());
    return fmt::format("{} {}{}, line {}", node.name(), index, name.empty() ? "" : " (" + name + ")", line(node));
  }
};

design::MapPosition position(const Document& doc, const pugi::xml_node& node) {
  if (const pugi::xml_attribute reference = node.attribute("pntRef")) {
    const auto found = doc.points.find(reference.value());
    return found == doc.points.end() ? design::MapPosition{nan, nan} : found->second;
  }
  const std::vector<double> v = numbers(node.child_value());
  if (v.size() < 2) return {nan, nan};
  return {v[1] * doc.metre, v[0] * doc.metre};
}

bool finite(const design::MapPosition& p) {
  return std::isfinite(p.easting) && std::isfinite(p.northing);
}
double apart(const design::MapPosition& a, const design::MapPosition& b) {
  return std::hypot(b.easting - a.easting, b.northing - a.northing);
}

/// Shape of a spiral's or cant ramp's type; nothing when it is not one of ours.
std::optional<Shape> shape_of(std::string type) {
  static const std::map<std::string, Shape> shapes = {{"clothoid", Shape::clothoid},
                                                      {"biquadratic", Shape::helmert},
                                                      {"biquadraticParabola", Shape::helmert},
                                                      {"bloss", Shape::bloss},
                                                      {"cosine", Shape::cosine},
                                                      {"sineHalfWave", Shape::cosine},
                                                      {"sinusoid", Shape::sine},
                                                      {"weinerBogen", Shape::viennese},
                                                      {"wienerBogen", Shape::viennese},
                                                      {"cubic", Shape::cubic_parabola},
                                                      {"cubicParabola", Shape::cubic_parabola},
                                                      {"japaneseCubic", Shape::cubic_parabola}};
  // Reversed types are the same curve: all these ramps are symmetric about their middle.
  if (type.rfind("rev", 0) == 0 && type.size() > 3) {
    type = type.substr(3);
    type[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(type[0])));
  }
  const auto found = shapes.find(type);
  if (found == shapes.end()) return std::nullopt;
  return found->second;
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

Expected<design::RawElement> read_element(const Document& doc, const pugi::xml_node& node, std::size_t index) {
  design::RawElement raw;
  raw.where = doc.where(node, index);
  raw.element.name = trimmed(node.attribute("name").value());
  raw.start = position(doc, node.child("Start"));
  raw.end = position(doc, node.child("End"));
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
    const design::MapPosition centre = position(doc, node.child("Center"));
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

Expected<void> read_horizontal(const Document& doc, const pugi::xml_node& alignment, design::RawAlignment& raw) {
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

/// An unsymmetrical parabola is two symmetrical ones; the gradient where they meet follows from their intersections.
void add_unsymmetrical(const design::VerticalPoint& p, double in, double out, double g1, double g2,
                       std::vector<design::VerticalPoint>& points) {
  points.push_back({p.distance - 0.5 * in, p.height - g1 * 0.5 * in, design::VerticalPoint::Curve::parabola, in});
  points.push_back({p.distance + 0.5 * out, p.height + g2 * 0.5 * out, design::VerticalPoint::Curve::parabola, out});
}

void read_profile(const Document& doc, const pugi::xml_node& alignment, double start, design::RawAlignment& raw) {
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

void read_cant(const Document& doc, const pugi::xml_node& alignment, double start, design::RawAlignment& raw) {
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

void read_chainage(const Document& doc, const pugi::xml_node& alignment, double start, design::RawAlignment& raw) {
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

design::Imported read_alignment(const Document& doc, const pugi::xml_node& node, const design::AuditLimits& limits) {
  design::RawAlignment raw;
  raw.file = doc.file;
  raw.name = trimmed(node.attribute("name").value());
  raw.crs = doc.crs;
  double start = attribute(node, "staStart") * doc.metre;
  if (std::isnan(start)) start = 0.0;
  if (auto read = read_horizontal(doc, node, raw); !read) return {raw.name, raw.findings, tl::unexpected(read.error())};
  read_profile(doc, node, start, raw);
  read_cant(doc, node, start, raw);
  read_chainage(doc, node, start, raw);
  return design::assemble(raw, limits);
}

Expected<void> read_head(Document& doc, const pugi::xml_node& root) {
  static const std::map<std::string, double> metres = {{"meter", 1.0},       {"millimeter", 1e-3},
                                                       {"centimeter", 1e-2}, {"kilometer", 1e3},
                                                       {"foot", 0.3048},     {"USSurveyFoot", 1200.0 / 3937.0},
                                                       {"inch", 0.0254},     {"mile", 1609.344}};
  for (const pugi::xml_node& system : root.child("Units").children()) {
    const std::string unit = system.attribute("linearUnit").value();
    if (unit.empty()) continue;
    const auto found = metres.find(unit);
    if (found == metres.end()) {
      return fail({.file = doc.file,
                   .line = doc.line(system),
                   .field = "linearUnit",
                   .found = "'" + unit + "'",
                   .expected = "meter, millimeter, foot, USSurveyFoot, ..."});
    }
    doc.metre = found->second;
  }
  if (const auto code = root.child("CoordinateSystem").attribute("epsgCode")) {
    if (std::string(code.value()).find_first_not_of("0123456789") == std::string::npos && *code.value() != 0) {
      doc.crs = fmt::format("EPSG:{}", code.value());
    }
  }
  for (const pugi::xml_node& group : root.children("CgPoints")) {
    for (const pugi::xml_node& point : group.children("CgPoint")) {
      doc.points[point.attribute("name").value()] = position(doc, point);
    }
  }
  return {};
}

}  // namespace

Expected<std::vector<design::Imported>> read_landxml(const std::filesystem::path& path,
                                                     const design::AuditLimits& limits) {
  Document doc;
  doc.file = path.string();
  std::ifstream in(path, std::ios::binary);
  if (!in) return fail({.file = doc.file, .found = "no readable file", .expected = "a LandXML 1.2 file"});
  doc.text.assign(std::istreambuf_iterator<char>(in), {});
  const pugi::xml_parse_result parsed = doc.xml.load_buffer(doc.text.data(), doc.text.size());
  if (!parsed) {
    const auto line = 1 + std::count(doc.text.begin(), doc.text.begin() + parsed.offset, '\n');
    return fail({.file = doc.file,
                 .line = static_cast<std::size_t>(line),
                 .found = parsed.description(),
                 .expected = "well-formed XML",
                 .advice = "the file may be cut short: export it again"});
  }
  const pugi::xml_node root = doc.xml.child("LandXML");
  if (!root) {
    return fail({.file = doc.file,
                 .found = fmt::format("the root element '{}'", doc.xml.document_element().name()),
                 .expected = "LandXML",
                 .advice = "export the alignment as LandXML 1.2"});
  }
  if (auto head = read_head(doc, root); !head) return tl::unexpected(head.error());
  std::vector<design::Imported> out;
  for (const pugi::xml_node& group : root.children("Alignments")) {
    for (const pugi::xml_node& node : group.children("Alignment")) {
      if (node.child("CoordGeom")) out.push_back(read_alignment(doc, node, limits));
    }
  }
  if (out.empty()) {
    return fail({.file = doc.file,
                 .field = "Alignments",
                 .found = "no Alignment with a CoordGeom",
                 .expected = "at least one",
                 .advice = "include the horizontal alignment in the export"});
  }
  return out;
}

}  // namespace versine::io
