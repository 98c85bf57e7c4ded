// SPDX-License-Identifier: Apache-2.0
#include "versine/io/geometry_csv.hpp"

#include <map>

#include "text_output.hpp"

namespace versine::io {
namespace {

/// Quotes only where a comma or a quote asks for it.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

double shown(const track::Geometry& g, const std::string& column, double value) {
  const track::Column* c = g.find(column);
  return c == nullptr ? value : value / c->scale;
}

}  // namespace

int decimals_of(const track::Column& column) {
  if (column.unit == "m") return 4;
  if (column.unit == "mm") return 3;
  return 5;
}

Expected<void> write_geometry_csv(const std::filesystem::path& path, const track::Geometry& g) {
  TextOutput out(path);
  out.text("distance_m,mileage_m,time_s,flags");
  std::vector<int> digits;
  std::vector<double> per;
  for (const track::Column& c : g.columns) {
    out.print(",{}", c.heading());
    if (!c.sigma.empty()) out.print(",sigma_{}", c.heading());
    digits.push_back(decimals_of(c));
    per.push_back(1.0 / c.scale);
  }
  out.end_line();
  for (std::size_t i = 0; i < g.size(); ++i) {
    out.number(g.mileage[i], 3);
    out.text(",");
    out.number(g.posted_at(g.mileage[i]), 3);
    out.text(",");
    out.number(g.time[i].seconds(), 4);
    out.print(",{}", g.flags[i]);
    for (std::size_t k = 0; k < g.columns.size(); ++k) {
      const track::Column& c = g.columns[k];
      out.text(",");
      out.number(c.value[i] * per[k], digits[k]);
      if (c.sigma.empty()) continue;
      out.text(",");
      out.number(static_cast<double>(c.sigma[i]) * per[k], digits[k]);
    }
    out.end_line();
  }
  return out.close();
}

Expected<void> write_geometry_columns_csv(const std::filesystem::path& path, const track::Geometry& g) {
  TextOutput out(path);
  out.print("# crs: {}\n# height datum: {}\n# trajectory: {}\n", g.crs, g.height_datum, g.origin);
  for (const auto& [what, how] : g.conventions) out.print("# {}: {}\n", what, how);
  out.text("column,unit,sigma,description\n");
  for (const track::Column& c : g.columns) {
    out.print("{},{},{},{}\n", c.heading(), field(c.unit), c.sigma.empty() ? "no" : "yes", field(c.description));
  }
  return out.close();
}

Expected<void> write_exceedances_csv(const std::filesystem::path& path, const track::Geometry& g,
                                     const track::Quality& q) {
  TextOutput out(path);
  out.text(
      "start_m,end_m,peak_m,length_m,column,unit,level,value,sigma,limit,probability_over,easting_m,northing_m,"
      "start_distance_m,end_distance_m,peak_distance_m\n");
  const track::Column *e = g.find("easting_axis"), *n = g.find("northing_axis");
  for (const track::Exceedance& x : q.exceedances) {
    const track::Column* c = g.find(x.column);
    out.print("{:.2f},{:.2f},{:.2f},{:.2f},{},{},{},", g.posted_at(x.start), g.posted_at(x.end), g.posted_at(x.peak),
              x.end - x.start, x.column, c->unit, x.level);
    out.number(x.value / c->scale, 3);
    out.text(",");
    out.number(x.sigma / c->scale, 3);
    out.text(",");
    out.number(x.limit / c->scale, 3);
    out.text(",");
    out.number(x.probability, 4);
    out.text(",");
    if (e != nullptr) out.number(e->value[x.index], 3);
    out.text(",");
    if (n != nullptr) out.number(n->value[x.index], 3);
    out.print(",{:.2f},{:.2f},{:.2f}", x.start, x.end, x.peak);
    out.end_line();
  }
  return out.close();
}

Expected<void> write_sections_csv(const std::filesystem::path& path, const track::Geometry& g,
                                  const track::Quality& q) {
  TextOutput out(path);
  out.text("start_m,end_m,tqi_mm,cosd_mm");
  if (!q.sections.empty()) {
    for (const auto& [name, sigma] : q.sections.front().sigma) out.print(",sigma_{}", g.at(name).heading());
  }
  out.text(",classes,over,start_distance_m,end_distance_m\n");
  for (const track::Section& s : q.sections) {
    out.print("{:.2f},{:.2f},", g.posted_at(s.start), g.posted_at(s.end));
    out.number(1e3 * s.tqi, 3);
    out.text(",");
    out.number(1e3 * s.cosd, 3);
    for (const auto& [name, sigma] : s.sigma) {
      out.text(",");
      out.number(shown(g, name, sigma), 3);
    }
    std::string classes, over;
    for (const auto& [name, k] : s.classes) classes += (classes.empty() ? "" : "; ") + name + " " + k;
    for (const auto& o : s.over) over += (over.empty() ? "" : "; ") + o;
    out.print(",{},{},{:.2f},{:.2f}\n", field(classes), field(over), s.start, s.end);
  }
  return out.close();
}

}  // namespace versine::io
