// SPDX-License-Identifier: Apache-2.0
#include "view_strips.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>

namespace versine::app {

namespace {

using json = nlohmann::ordered_json;

/// A group of columns: a pattern of their names without unit, and the strip that each of them becomes.
struct Group {
  const char* tab;
  std::regex pattern;
  std::function<ViewStrip(const std::smatch&, const json&)> strip;
};

const char* sideways = "+ right";
const char* upwards = "+ up";

std::string band_note(const std::string& band, const json& settings) {
  for (const json& b : settings.value("band", json::array())) {
    if (b.value("name", "") != band) continue;
    return fmt::format("{}, {:g}–{:g} m",
                       band == "d1"   ? "D1"
                       : band == "d2" ? "D2"
                                      : band,
                       b.value("shortest_m", 0.0), b.value("longest_m", 0.0));
  }
  return band;
}

ViewStrip level_or_alignment(const std::smatch& m, const json& settings) {
  const bool level = m[1] == "level";
  return {.title = fmt::format("{} {}", level ? "Level" : "Alignment", m[2].str()),
          .note = band_note(m[3].str(), settings),
          .positive = level ? upwards : sideways};
}

ViewStrip deviation(const std::smatch& m, const json&) {
  const bool lateral = m[1] == "lateral";
  return {.title = lateral ? "Lateral to design" : "Height to design",
          .note = m[2] == "axis" ? "track axis" : m[2].str() + " rail",
          .positive = lateral ? sideways : upwards};
}

ViewStrip versine(const std::smatch& m, const json&) {
  const bool lateral = m[1] == "lateral";
  return {.title = fmt::format("Versine {}", m[2].str()),
          .note = fmt::format("{}, chord {}", lateral ? "horizontal" : "vertical", m[3].str()),
          .positive = lateral ? "+ right of chord" : "+ above chord"};
}

ViewStrip check(const std::smatch& m, const json&) {
  return {.title = fmt::format("{} check {}", m[1].str(), m[3].str()),
          .note = m[2].str() + (m[4].matched ? ", worst phase" : ""),
          .positive = m[2] == "lateral" ? sideways : upwards};
}

std::function<ViewStrip(const std::smatch&, const json&)> fixed(ViewStrip strip) {
  return [strip = std::move(strip)](const std::smatch&, const json&) { return strip; };
}

const std::vector<Group>& groups() {
  static const std::vector<Group> all = [] {
    std::vector<Group> g;
    const auto add = [&](const char* tab, const char* pattern, auto strip) {
      g.push_back({tab, std::regex(pattern), strip});
    };
    add("strips", "curvature",
        fixed({.title = "Curvature · cant", .positive = "+ right-hand curve", .companion = "cross_level_mm"}));
    add("strips", "gauge_deviation", fixed({.title = "Gauge", .note = "deviation", .positive = "+ wide"}));
    add("strips", "cross_level_deviation",
        fixed({.title = "Cross level", .note = "to design", .positive = "+ left rail higher"}));
    add("strips", "twist_(.+)", [](const std::smatch& m, const json&) {
      return ViewStrip{.title = "Twist", .note = "base " + m[1].str(), .positive = "+ left rail rising"};
    });
    add("strips", "(level)_(left|right)_(d1)", level_or_alignment);
    add("strips", "(alignment)_(left|right)_(d1)", level_or_alignment);
    add("strips", "deviation_(lateral|vertical)_(axis)", deviation);
    add("waves", "(level)_(left|right)_(.+)", level_or_alignment);
    add("waves", "(alignment)_(left|right)_(.+)", level_or_alignment);
    add("versines", "versine_(lateral)_(left|right)_(.+)", versine);
    add("versines", "versine_(vertical)_(left|right)_(.+)", versine);
    add("checks", "check_(.+)_(lateral|vertical)_(left|right)", check);
    add("worst", "check_(.+)_(lateral|vertical)_(left|right)(_worst)", check);
    add("line", "gradient", fixed({.title = "Gradient", .positive = "+ uphill"}));
    add("line", "height_axis", fixed({.title = "Height", .note = "track axis", .positive = upwards}));
    add("line", "gauge", fixed({.title = "Gauge", .note = "absolute"}));
    add("line", "cross_level", fixed({.title = "Cross level", .note = "absolute", .positive = "+ left rail higher"}));
    add("line", "deviation_(lateral|vertical)_(left|right)", deviation);
    return g;
  }();
  return all;
}

struct Unit {
  const char *ending, *shown;
  int digits;
};
constexpr Unit units[] = {{"_mm_per_m", "mm/m", 2}, {"_per_km", "1/km", 3}, {"_permille", "‰", 2},
                          {"_mm", "mm", 1},         {"_deg", "°", 3},       {"_m", "m", 3}};

}  // namespace

const std::vector<ViewTab>& view_tabs() {
  static const std::vector<ViewTab> tabs = {
      {"strips", "Strips"},     {"waves", "Long waves"}, {"versines", "Versines"},     {"checks", "Chord checks"},
      {"worst", "Worst phase"}, {"line", "Line"},        {"difference", "Difference"}, {"adjustment", "Adjustment"}};
  return tabs;
}

std::vector<ViewStrip> geometry_strips(const std::vector<std::string>& columns, const json& settings) {
  std::vector<std::pair<std::size_t, ViewStrip>> found;
  for (const std::string& column : columns) {
    if (column.starts_with("sigma_")) continue;
    const auto unit =
        std::find_if(std::begin(units), std::end(units), [&](const Unit& u) { return column.ends_with(u.ending); });
    if (unit == std::end(units)) continue;
    const std::string name = column.substr(0, column.size() - std::string(unit->ending).size());
    for (std::size_t k = 0; k < groups().size(); ++k) {
      std::smatch match;
      if (!std::regex_match(name, match, groups()[k].pattern)) continue;
      ViewStrip strip = groups()[k].strip(match, settings);
      strip.id = column;
      strip.unit = unit->shown;
      strip.digits = unit->digits;
      strip.tab = groups()[k].tab;
      if (std::find(columns.begin(), columns.end(), strip.companion) == columns.end()) strip.companion.clear();
      found.emplace_back(k, std::move(strip));
      break;
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<ViewStrip> out;
  for (auto& [rank, strip] : found) out.push_back(std::move(strip));
  // Without design there is no deviation of the cross level: the first tab shows the cross level itself.
  const bool deviates =
      std::any_of(out.begin(), out.end(), [](const ViewStrip& s) { return s.id == "cross_level_deviation_mm"; });
  for (std::size_t i = 0; !deviates && i < out.size(); ++i) {
    if (out[i].id == "cross_level_mm") {
      out[i].tab = "strips";
      std::rotate(out.begin() + std::min<std::ptrdiff_t>(2, static_cast<std::ptrdiff_t>(i)),
                  out.begin() + static_cast<std::ptrdiff_t>(i), out.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      break;
    }
  }
  return out;
}

}  // namespace versine::app
