// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "landxml_parts.hpp"
#include "versine/io/landxml.hpp"

namespace versine::io {

namespace {

using namespace detail;

design::Imported read_alignment(const LandXmlDocument& doc, const pugi::xml_node& node,
                                const design::AuditLimits& limits) {
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

Expected<void> read_head(LandXmlDocument& doc, const pugi::xml_node& root) {
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
      doc.points[point.attribute("name").value()] = doc.position(point);
    }
  }
  return {};
}

}  // namespace

Expected<std::vector<design::Imported>> read_landxml(const std::filesystem::path& path,
                                                     const design::AuditLimits& limits) {
  LandXmlDocument doc;
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
