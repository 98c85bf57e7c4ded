// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "versine/report/drawing.hpp"

namespace versine::report {

struct Cell {
  std::string text;
  std::uint32_t colour = 0x1b1f24;
  bool bold = false;
};

/// A table of a report. Texts are shown as the result's files hold them, so that both can be compared.
struct Table {
  struct Column {
    std::string title;  ///< with unit: "peak, m"
    Anchor align = Anchor::end;
    bool wrap = false;     ///< long texts go on in further lines
    double share = 1.0;    ///< of the width that is left over
    double minimum = 0.0;  ///< mm
  };
  std::string id;                  ///< of sheet and tests: "exceedances"
  std::string title;               ///< for people
  std::vector<std::string> notes;  ///< above the table
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
  std::string empty;        ///< said when there is no row
  int blocks = 1;           ///< narrow tables stand side by side
  double row_height = 0.0;  ///< mm; 0: by the font
};

/// Lays the table out into boxes: the first is `first`, more come from `next`. Returns where the content ends in the
/// last box, mm.
double draw_table(const Table& table, Drawing*& page, Box box, const std::function<Box(Drawing*&)>& next);

}  // namespace versine::report
