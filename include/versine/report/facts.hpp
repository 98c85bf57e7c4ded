// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "versine/report/document.hpp"
#include "versine/report/table.hpp"

/// What every report tells besides its results: who, where, when, from which files, with which settings.
namespace versine::report {

/// What the job's `[report]` table says for the cover; empty lines are left blank, to be filled in by hand.
struct Cover {
  std::string line, track, direction, date, shift, operated_by, client, trolley, calibrated, remarks;
};

/// A table as a file of the result holds it: texts.
struct RawTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;

  [[nodiscard]] bool has(const std::string& column) const;
  /// Empty when there is no such column.
  [[nodiscard]] const std::string& at(std::size_t row, const std::string& column) const;
  /// NaN when there is no such column, or no number.
  [[nodiscard]] double number(std::size_t row, const std::string& column) const;
};

struct Facts {
  Cover cover;
  std::string title;   ///< of the job
  std::string folder;  ///< of the result, as it was named
  std::string command, version, started;
  RawTable inputs;    ///< role, file, bytes, sha256
  RawTable settings;  ///< key, value: those that are not the default or matter for the result
  RawTable timings;   ///< stage, seconds
  std::vector<std::string> warnings;
  RawTable findings;    ///< sensor, kind, from, to, count, action, detail
  RawTable rejections;  ///< sensor, reason, count, first, last, worst: one row for many of a kind
};

/// Line and track, or the job's title, for the head of each page.
[[nodiscard]] std::string subject_of(const Facts& facts);

/// Adds pages to a document, one chapter at a time.
class Pages {
 public:
  explicit Pages(Document& document) : document_(&document) {}
  /// Starts a chapter with its first page, and returns the room for content.
  Box begin(std::string id, std::string title);
  /// The next page of the chapter.
  Box next();
  [[nodiscard]] Drawing& page() { return document_->sections.back().pages.back(); }
  /// Lays a table out from `top` (mm; 0: the top of the content) of the present page on, and keeps it for the
  /// workbook. Returns where it ends.
  double add(const Table& table, double top = 0.0);

 private:
  Document* document_;
};

/// Pairs of name and value, one below the other; long values wrap. Returns the lower end, mm.
double draw_pairs(Drawing& d, const Box& box, const std::vector<std::pair<std::string, std::string>>& pairs,
                  double name_width, double size = 2.7);

/// Cells of a raw table's columns, in the order asked for.
[[nodiscard]] std::vector<std::vector<Cell>> cells_of(const RawTable& raw, const std::vector<std::string>& columns);

/// Chapters that every report ends with: warnings, findings and rejections; inputs, settings and timings.
void add_record(Pages& pages, const Facts& facts, const Texts& texts);
void add_inputs(Pages& pages, const Facts& facts, const Texts& texts);

}  // namespace versine::report
