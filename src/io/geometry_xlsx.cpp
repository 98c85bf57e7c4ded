// SPDX-License-Identifier: Apache-2.0
#include "versine/io/geometry_xlsx.hpp"

#include <xlsxwriter.h>

#include <algorithm>
#include <cmath>

namespace versine::io {
namespace {

/// One sheet with a bold, frozen head.
class Sheet {
 public:
  Sheet(lxw_workbook* book, const char* name, lxw_format* bold)
      : sheet_(workbook_add_worksheet(book, name)), bold_(bold) {
    worksheet_freeze_panes(sheet_, 1, 0);
  }
  void head(const std::string& text) { worksheet_write_string(sheet_, 0, column_++, text.c_str(), bold_); }
  void next() {
    ++row_;
    column_ = 0;
  }
  void put(const std::string& text) { worksheet_write_string(sheet_, row_, column_++, text.c_str(), nullptr); }
  void put(double value, int digits = 3) {
    const double scale = std::pow(10.0, digits);
    if (std::isfinite(value)) worksheet_write_number(sheet_, row_, column_, std::round(value * scale) / scale, nullptr);
    ++column_;
  }

 private:
  lxw_worksheet* sheet_;
  lxw_format* bold_;
  lxw_row_t row_ = 0;
  lxw_col_t column_ = 0;
};

void write_table(Sheet& s, const track::Geometry& g, std::size_t stride) {
  s.head("mileage_m");
  for (const track::Column& c : g.columns) s.head(c.heading());
  for (std::size_t i = 0; i < g.size(); i += stride) {
    s.next();
    s.put(g.posted_at(g.mileage[i]));
    for (const track::Column& c : g.columns) s.put(c.value[i] / c.scale, c.unit == "m" ? 4 : 3);
  }
}

void write_exceedances(Sheet& s, const track::Geometry& g, const track::Quality& q) {
  for (const char* h : {"start_m", "end_m", "peak_m", "length_m", "column", "unit", "level", "value", "sigma", "limit",
                        "probability_over", "done by", "date"}) {
    s.head(h);
  }
  for (const track::Exceedance& x : q.exceedances) {
    const track::Column& c = g.at(x.column);
    s.next();
    for (const double v : {g.posted_at(x.start), g.posted_at(x.end), g.posted_at(x.peak), x.end - x.start}) s.put(v, 2);
    s.put(x.column);
    s.put(c.unit);
    s.put(x.level);
    for (const double v : {x.value / c.scale, x.sigma / c.scale, x.limit / c.scale}) s.put(v);
    s.put(x.probability, 4);
  }
}

void write_sections(Sheet& s, const track::Geometry& g, const track::Quality& q) {
  for (const char* h : {"start_m", "end_m", "tqi_mm", "cosd_mm"}) s.head(h);
  if (q.sections.empty()) return;
  for (const auto& [name, sigma] : q.sections.front().sigma) s.head("sigma_" + g.at(name).heading());
  s.head("classes");
  s.head("over");
  for (const track::Section& x : q.sections) {
    s.next();
    s.put(g.posted_at(x.start), 2);
    s.put(g.posted_at(x.end), 2);
    s.put(1e3 * x.tqi);
    s.put(1e3 * x.cosd);
    for (const auto& [name, sigma] : x.sigma) s.put(sigma / g.at(name).scale);
    std::string classes, over;
    for (const auto& [name, k] : x.classes) classes += (classes.empty() ? "" : "; ") + name + " " + k;
    for (const auto& o : x.over) over += (over.empty() ? "" : "; ") + o;
    s.put(classes);
    s.put(over);
  }
}

}  // namespace

Expected<void> write_geometry_xlsx(const std::filesystem::path& path, const track::Geometry& g,
                                   const track::Quality* quality, const track::Geometry* at_sleepers, double interval) {
  lxw_workbook* book = workbook_new(path.string().c_str());
  const auto refuse = [&](const char* why) {
    return fail({.file = path.string(),
                 .found = "a workbook that cannot be written",
                 .expected = "a writable place",
                 .advice = why});
  };
  if (book == nullptr) return refuse("check the folder");
  lxw_format* bold = workbook_add_format(book);
  format_set_bold(bold);
  {
    Sheet s(book, "conventions", bold);
    s.head("what");
    s.head("convention");
    const auto line = [&](const std::string& a, const std::string& b) {
      s.next();
      s.put(a);
      s.put(b);
    };
    line("crs", g.crs);
    line("height datum", g.height_datum);
    line("trajectory", g.origin);
    for (const auto& [what, how] : g.conventions) line(what, how);
    if (quality != nullptr) line("limits", quality->profile + "; " + quality->source);
    for (const track::Column& c : g.columns) line(c.heading(), c.description);
  }
  if (quality != nullptr) {
    Sheet exceedances(book, "exceedances", bold), sections(book, "sections", bold);
    write_exceedances(exceedances, g, *quality);
    write_sections(sections, g, *quality);
  }
  Sheet table(book, at_sleepers != nullptr ? "sleepers" : "geometry", bold);
  const track::Geometry& shown = at_sleepers != nullptr ? *at_sleepers : g;
  const auto wanted = static_cast<std::size_t>(
      g.step > 0 && at_sleepers == nullptr ? std::max(1.0, std::round(interval / g.step)) : 1.0);
  write_table(table, shown, std::max(wanted, shown.size() / 1'000'000 + 1));
  if (const lxw_error error = workbook_close(book); error != LXW_NO_ERROR) return refuse(lxw_strerror(error));
  return {};
}

}  // namespace versine::io
