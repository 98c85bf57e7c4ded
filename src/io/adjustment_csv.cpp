// SPDX-License-Identifier: Apache-2.0
#include "versine/io/adjustment_csv.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "text_output.hpp"

namespace versine::io {
namespace {

using Cell = std::function<std::string(std::size_t)>;

std::string text_of(double value, int digits, bool comma) {
  if (!std::isfinite(value)) return "";
  std::string s = fmt::format("{:.{}f}", value, digits);
  if (s.front() == '-' && s.find_first_not_of("-0.") == std::string::npos) s.erase(0, 1);  // no -0.0
  if (comma) std::replace(s.begin(), s.end(), '.', ',');
  return s;
}

std::map<std::string, Cell> cells(const track::Geometry& g, const track::Adjustment* slew,
                                  const track::Adjustment* lift, const AdjustmentTable& t) {
  const double sign = t.slew_right_positive ? 1.0 : -1.0;
  const bool comma = t.decimal_comma;
  const auto number = [comma](std::function<double(std::size_t)> f, int digits) -> Cell {
    return [f = std::move(f), digits, comma](std::size_t i) { return text_of(f(i), digits, comma); };
  };
  const auto column = [&g](const char* name, double factor) {
    const track::Column* c = g.find(name);
    return [c, factor](std::size_t i) { return c == nullptr ? std::nan("") : factor * c->value[i]; };
  };
  const auto level = column("cross_level", 1e3), deviation = column("cross_level_deviation", 1e3);
  const auto cant = [level, deviation](std::size_t i) {
    const double d = deviation(i);
    return level(i) - (std::isfinite(d) ? d : 0.0);
  };
  const auto of = [](const track::Adjustment* a, bool movement, double factor) {
    return [a, movement, factor](std::size_t i) {
      return a == nullptr ? std::nan("") : factor * (movement ? a->movement[i] : a->after[i]);
    };
  };
  return {{"mileage_m", number([&g](std::size_t i) { return g.posted_at(g.mileage[i]); }, 3)},
          {"mileage_km", number([&g](std::size_t i) { return 1e-3 * g.posted_at(g.mileage[i]); }, 6)},
          {"distance_m", number([&g](std::size_t i) { return g.mileage[i]; }, 3)},
          {"slew_mm", number(of(slew, true, 1e3 * sign), 1)},
          {"lift_mm", number(of(lift, true, 1e3), 1)},
          {"slew_left_over_mm", number(of(slew, false, 1e3 * sign), 1)},
          {"lift_left_over_mm", number(of(lift, false, 1e3), 1)},
          {"cant_mm", number(cant, 1)},
          {"cross_level_mm", number(level, 1)},
          {"easting_m", number(column("easting_axis", 1.0), 4)},
          {"northing_m", number(column("northing_axis", 1.0), 4)},
          {"height_m", number(column("height_axis", 1.0), 4)},
          {"reference_rail", [cant](std::size_t i) { return std::string(cant(i) > 0.0 ? "right" : "left"); }}};
}

}  // namespace

Expected<void> write_adjustment_csv(const std::filesystem::path& path, const track::Geometry& g,
                                    const track::Adjustment* slew, const track::Adjustment* lift,
                                    const AdjustmentTable& t) {
  const auto known = cells(g, slew, lift, t);
  std::vector<const Cell*> row;
  for (const std::string& name : t.columns) {
    const auto it = known.find(name);
    if (it == known.end()) {
      std::string names;
      for (const auto& [k, cell] : known) names += (names.empty() ? "" : ", ") + k;
      return fail({.field = "adjustment.columns", .found = "'" + name + "'", .expected = "one of " + names});
    }
    row.push_back(&it->second);
  }
  TextOutput out(path);
  out.print(
      "# slew: movement of the track, positive to the {} in the direction of increasing mileage\n"
      "# lift: movement upwards of the lower rail\n"
      "# cant: positive when the left rail is higher; the reference rail is the lower one\n",
      t.slew_right_positive ? "right" : "left");
  out.print("{}\n", fmt::join(t.columns, t.delimiter));
  const auto stride =
      std::max<std::size_t>(1, g.step > 0 ? static_cast<std::size_t>(std::llround(t.interval / g.step)) : 1);
  for (std::size_t i = 0; i < g.size(); i += stride) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (k > 0) out.text(t.delimiter);
      out.text((*row[k])(i));
    }
    out.end_line();
  }
  return out.close();
}

}  // namespace versine::io
