// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "versine/design/assemble.hpp"

namespace versine::io::detail {

/// NaN when the text is no number. "INF" and "NaN" are words of LandXML.
[[nodiscard]] double number(std::string_view text);
[[nodiscard]] double attribute(const pugi::xml_node& node, const char* name);
[[nodiscard]] std::vector<double> numbers(const std::string& text);
[[nodiscard]] std::string trimmed(const std::string& text);

/// The document with what every alignment in it needs.
struct LandXmlDocument {
  std::string file, text, crs;
  double metre = 1.0;  ///< per unit of length
  pugi::xml_document xml;
  std::map<std::string, design::MapPosition> points;  ///< CgPoint by name

  [[nodiscard]] std::size_t line(const pugi::xml_node& node) const;
  [[nodiscard]] std::string where(const pugi::xml_node& node, std::size_t index) const;
  /// Northing and easting of a point, or of the one that it refers to; NaN where there is none.
  [[nodiscard]] design::MapPosition position(const pugi::xml_node& node) const;
};

/// Shape of a spiral's or cant ramp's type; nothing when it is not one of ours.
[[nodiscard]] std::optional<design::Shape> shape_of(std::string type);

/// The parts of an alignment, added to `raw`. `start`: the station of its first point, m.
[[nodiscard]] Expected<void> read_horizontal(const LandXmlDocument& doc, const pugi::xml_node& alignment,
                                             design::RawAlignment& raw);
void read_profile(const LandXmlDocument& doc, const pugi::xml_node& alignment, double start, design::RawAlignment& raw);
void read_cant(const LandXmlDocument& doc, const pugi::xml_node& alignment, double start, design::RawAlignment& raw);
void read_chainage(const LandXmlDocument& doc, const pugi::xml_node& alignment, double start,
                   design::RawAlignment& raw);

}  // namespace versine::io::detail
