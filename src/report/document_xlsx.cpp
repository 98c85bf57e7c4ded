// SPDX-License-Identifier: Apache-2.0
#include <xlsxwriter.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>

#include "versine/report/document.hpp"

namespace versine::report {

namespace {

/// The number that a text is, whole; nothing for names, places like 12+345 and empty cells.
std::optional<double> number_in(const std::string& text) {
  if (text.empty() || text.find_first_not_of("0123456789.-+eE") != std::string::npos) return {};
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end != text.c_str() + text.size() || !std::isfinite(value)) return {};
  return value;
}

/// Excel's rules: 31 characters, none of []:*?/\, each name once.
std::string sheet_name(const Table& t, std::set<std::string>& taken) {
  std::string name = t.id.substr(0, 31);
  for (int k = 2; !taken.insert(name).second; ++k) name = t.id.substr(0, 28) + " " + std::to_string(k);
  return name;
}

void write_sheet(lxw_worksheet* sheet, const Table& t, lxw_format* bold, lxw_format* wrap) {
  lxw_row_t row = 0;
  worksheet_write_string(sheet, row++, 0, t.title.c_str(), bold);
  for (const std::string& note : t.notes) worksheet_write_string(sheet, row++, 0, note.c_str(), nullptr);
  ++row;
  for (std::size_t k = 0; k < t.columns.size(); ++k) {
    const auto column = static_cast<lxw_col_t>(k);
    worksheet_write_string(sheet, row, column, t.columns[k].title.c_str(), bold);
    std::size_t longest = t.columns[k].title.size();
    for (std::size_t i = 0; i < t.rows.size() && i < 200; ++i) {
      if (k < t.rows[i].size()) longest = std::max(longest, t.rows[i][k].text.size());
    }
    worksheet_set_column(sheet, column, column, std::clamp(static_cast<double>(longest) + 1.0, 8.0, 60.0), nullptr);
  }
  worksheet_freeze_panes(sheet, row + 1, 0);
  for (const auto& cells : t.rows) {
    ++row;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const auto column = static_cast<lxw_col_t>(k);
      if (const auto number = number_in(cells[k].text); number && t.columns[k].align == Anchor::end) {
        worksheet_write_number(sheet, row, column, *number, nullptr);
      } else {
        worksheet_write_string(sheet, row, column, cells[k].text.c_str(), t.columns[k].wrap ? wrap : nullptr);
      }
    }
  }
}

}  // namespace

Expected<void> write_document_xlsx(const std::filesystem::path& path, const Document& document) {
  const auto refuse = [&](const char* found) {
    return fail({.file = path.string(),
                 .found = found,
                 .expected = "a writable place with free space",
                 .advice = "check permissions and free space"});
  };
  if (!std::ofstream(path, std::ios::binary)) return refuse("that it cannot be written");  // else the library prints
  lxw_workbook* book = workbook_new(path.string().c_str());
  if (book == nullptr) return refuse("a workbook that cannot be made");
  lxw_format *bold = workbook_add_format(book), *wrap = workbook_add_format(book);
  format_set_bold(bold);
  format_set_text_wrap(wrap);
  format_set_align(wrap, LXW_ALIGN_VERTICAL_TOP);
  std::set<std::string> taken;
  for (const Table& t : document.tables) {
    write_sheet(workbook_add_worksheet(book, sheet_name(t, taken).c_str()), t, bold, wrap);
  }
  if (document.tables.empty()) workbook_add_worksheet(book, nullptr);
  if (const lxw_error error = workbook_close(book); error != LXW_NO_ERROR) return refuse(lxw_strerror(error));
  return {};
}

}  // namespace versine::report
