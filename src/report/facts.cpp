// SPDX-License-Identifier: Apache-2.0
#include "versine/report/facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "colours.hpp"

namespace versine::report {

namespace {

using colours::muted;
const std::string nothing;

std::size_t index_of(const RawTable& t, const std::string& column) {
  return static_cast<std::size_t>(std::find(t.header.begin(), t.header.end(), column) - t.header.begin());
}

}  // namespace

bool RawTable::has(const std::string& column) const {
  return index_of(*this, column) < header.size();
}

const std::string& RawTable::at(std::size_t row, const std::string& column) const {
  const std::size_t k = index_of(*this, column);
  return k < rows[row].size() ? rows[row][k] : nothing;
}

double RawTable::number(std::size_t row, const std::string& column) const {
  const std::string& text = at(row, column);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return text.empty() || end != text.c_str() + text.size() ? std::numeric_limits<double>::quiet_NaN() : value;
}

std::string subject_of(const Facts& f) {
  if (f.cover.line.empty()) return f.title;
  return f.cover.track.empty() ? f.cover.line : f.cover.line + " \xC2\xB7 " + f.cover.track;
}

Box Pages::begin(std::string id, std::string title) {
  document_->sections.push_back({std::move(id), std::move(title), {}});
  return next();
}

Box Pages::next() {
  document_->sections.back().pages.emplace_back();
  return content_box(page());
}

double Pages::add(const Table& table, double top) {
  document_->tables.push_back(table);
  Box box = content_box(page());
  if (top > box.y) {
    box.height = box.bottom() - top;
    box.y = top;
  }
  if (box.height < 25.0) box = next();
  Drawing* drawing = &page();
  return draw_table(table, drawing, box, [this](Drawing*& d) {
    const Box room = next();
    d = &page();
    return room;
  });
}

double draw_pairs(Drawing& d, const Box& box, const std::vector<std::pair<std::string, std::string>>& pairs,
                  double name_width, double size) {
  double y = box.y;
  const double leading = 1.45 * size;
  for (const auto& [name, value] : pairs) {
    d.begin(Group{"row", {}, {}});
    double used = 0.0;
    for (const std::string& line : wrapped(name, name_width - 2.0, size)) {
      d.text({box.x, y + size + used}, line, {.size = size, .colour = muted});
      used += leading;
    }
    double written = 0.0;
    for (const std::string& line : wrapped(value, box.width - name_width, size)) {
      d.text({box.x + name_width, y + size + written}, line, {.size = size});
      written += leading;
    }
    d.end();
    if (value.empty()) {
      d.line({box.x + name_width, y + size + 0.7}, {box.right(), y + size + 0.7}, {0xb4bcc4, 0.15, Dash::dotted});
    }
    y += std::max(used, written) + 0.35 * size;
  }
  return y;
}

std::vector<std::vector<Cell>> cells_of(const RawTable& raw, const std::vector<std::string>& columns) {
  std::vector<std::vector<Cell>> out;
  out.reserve(raw.rows.size());
  for (std::size_t i = 0; i < raw.rows.size(); ++i) {
    auto& row = out.emplace_back();
    for (const std::string& column : columns) row.push_back({raw.at(i, column)});
  }
  return out;
}

namespace {
std::vector<std::vector<Cell>> translated(std::vector<std::vector<Cell>> rows, const Texts& t) {
  for (auto& row : rows) {
    for (Cell& cell : row) cell.text = t.phrase(cell.text);
  }
  return rows;
}
}  // namespace

void add_record(Pages& pages, const Facts& f, const Texts& t) {
  pages.begin("record", t("record.title"));
  Table warnings{.id = "warnings", .title = t("record.warnings"), .empty = t("record.no_warnings")};
  warnings.columns = {{t("record.number")}, {t("record.warning"), Anchor::start, true}};
  for (std::size_t i = 0; i < f.warnings.size(); ++i) {
    warnings.rows.push_back({{fmt::format("{}", i + 1)}, {t.phrase(f.warnings[i])}});
  }
  double y = pages.add(warnings);
  Table findings{.id = "findings", .title = t("record.findings"), .empty = t("record.no_findings")};
  findings.columns = {{t("record.sensor"), Anchor::start},
                      {t("record.kind"), Anchor::start},
                      {t("record.from"), Anchor::start},
                      {t("record.to_s")},
                      {t("record.count")},
                      {t("record.action"), Anchor::start},
                      {t("record.detail"), Anchor::start, true}};
  findings.rows = translated(cells_of(f.findings, {"sensor", "kind", "from", "to_s", "count", "action", "detail"}), t);
  y = pages.add(findings, y + 5.0);
  Table rejections{.id = "rejections",
                   .title = t("record.rejections"),
                   .notes = {t("record.rejections_note")},
                   .empty = t("record.no_rejections")};
  rejections.columns = {{t("record.sensor"), Anchor::start},
                        {t("record.count")},
                        {t("record.first_s")},
                        {t("record.last_s")},
                        {t("record.worst")},
                        {t("record.reason"), Anchor::start, true}};
  rejections.rows = translated(cells_of(f.rejections, {"sensor", "count", "first_s", "last_s", "worst", "reason"}), t);
  pages.add(rejections, y + 5.0);
}

void add_inputs(Pages& pages, const Facts& f, const Texts& t) {
  pages.begin("inputs", t("inputs.title"));
  Table files{.id = "inputs", .title = t("inputs.files"), .empty = t("inputs.none")};
  files.columns = {{t("inputs.role"), Anchor::start},
                   {t("inputs.file"), Anchor::start, true},
                   {t("inputs.bytes")},
                   {"SHA-256", Anchor::start}};
  files.rows = cells_of(f.inputs, {"role", "file", "bytes", "sha256"});
  double y = pages.add(files);
  Table settings{.id = "settings",
                 .title = t("inputs.settings"),
                 .notes = {t("inputs.settings_note")},
                 .empty = t("inputs.none"),
                 .blocks = 3};
  settings.columns = {{t("inputs.key"), Anchor::start, true, 1.0}, {t("inputs.value"), Anchor::start, true, 1.3}};
  settings.rows = cells_of(f.settings, {"key", "value"});
  y = pages.add(settings, y + 5.0);
  Table timings{.id = "timings", .title = t("inputs.timings"), .empty = t("inputs.none"), .blocks = 2};
  timings.columns = {{t("inputs.stage"), Anchor::start, true}, {t("inputs.seconds"), Anchor::end, false, 1.0, 20.0}};
  timings.rows = cells_of(f.timings, {"stage", "seconds"});
  pages.add(timings, y + 5.0);
}

}  // namespace versine::report
