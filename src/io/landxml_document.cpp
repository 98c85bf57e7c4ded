// SPDX-License-Identifier: Apache-2.0
#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "landxml_parts.hpp"
#include "versine/core/numbers.hpp"

namespace versine::io::detail {

using design::Shape;
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

std::size_t LandXmlDocument::line(const pugi::xml_node& node) const {
  const auto at = std::clamp<std::ptrdiff_t>(node.offset_debug(), 0, static_cast<std::ptrdiff_t>(text.size()));
  return 1 + static_cast<std::size_t>(std::count(text.begin(), text.begin() + at, '\n'));
}

std::string LandXmlDocument::where(const pugi::xml_node& node, std::size_t index) const {
  const std::string name = trimmed(node.attribute("name").value());
  return fmt::format("{} {}{}, line {}", node.name(), index, name.empty() ? "" : " (" + name + ")", line(node));
}

design::MapPosition LandXmlDocument::position(const pugi::xml_node& node) const {
  if (const pugi::xml_attribute reference = node.attribute("pntRef")) {
    const auto found = points.find(reference.value());
    return found == points.end() ? design::MapPosition{nan, nan} : found->second;
  }
  const std::vector<double> v = numbers(node.child_value());
  if (v.size() < 2) return {nan, nan};
  return {v[1] * metre, v[0] * metre};
}

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

}  // namespace versine::io::detail
