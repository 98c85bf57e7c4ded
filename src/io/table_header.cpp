// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "table_fields.hpp"
#include "versine/core/text.hpp"
#include "versine/io/table_reader.hpp"

namespace versine::io {

namespace {
bool is_comment(std::string_view line) {
  const std::size_t at = line.find_first_not_of(" \t");
  return at == std::string_view::npos || line[at] == '%' || line[at] == '#';
}

char guess_delimiter(std::string_view line) {
  for (const char c : {'\t', ';', ','}) {
    if (line.find(c) != std::string_view::npos) return c;
  }
  return ' ';
}

bool numeric(std::string_view field, char point) {
  if (field.empty() || field == "nan" || field == "NaN") return true;
  return std::all_of(field.begin(), field.end(),
                     [point](char c) {
                       return (c >= '0' && c <= '9') || c == point || c == '-' || c == '+' || c == 'e' || c == 'E';
                     }) &&
         field.find_first_of("0123456789") != std::string_view::npos;
}

std::optional<std::size_t> column_number(std::string_view text) {
  std::size_t n = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), n);
  if (code != std::errc() || end != text.data() + text.size() || n == 0) return std::nullopt;
  return n;
}

bool same_ignoring_case(std::string_view a, std::string_view b) {
  const auto low = [](char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : int{c}; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [low](char x, char y) { return low(x) == low(y); });
}
}  // namespace

Expected<TableReader> TableReader::open(LineReader lines, const TableFile& file) {
  TableReader table(std::move(lines));
  if (const auto done = table.read_header(file); !done) return tl::unexpected(done.error());
  return table;
}

Expected<void> TableReader::read_header(const TableFile& file) {
  std::string_view line;
  std::string comment;
  bool any = false;
  while (lines_.next(line)) {
    if (lines_.line_number() <= file.skip_lines) continue;
    if (!is_comment(line)) {
      any = true;
      break;
    }
    if (const std::size_t at = line.find_first_not_of(" \t%#"); at != std::string_view::npos) {
      comment = line.substr(at);
    } else {
      comment.clear();
    }
  }
  if (lines_.error()) return fail(*lines_.error());
  if (!any) {
    return fail({.file = name(),
                 .line = lines_.line_number(),
                 .found = "no line of data",
                 .expected = "a header and samples",
                 .advice = "check whether the recorder or the copy was interrupted, and skip_lines"});
  }
  if (file.delimiter.empty()) {
    delimiter_ = guess_delimiter(line);
  } else if (file.delimiter == "blank" || file.delimiter == " ") {
    delimiter_ = ' ';
  } else if (file.delimiter.size() == 1) {
    delimiter_ = file.delimiter.front();
  } else {
    return fail({.file = name(),
                 .field = "delimiter",
                 .found = "'" + file.delimiter + "'",
                 .expected = "one character, or \"blank\"",
                 .advice = "leave the key out: the delimiter is found from the header"});
  }
  const std::vector<std::string> first = split_fields(line, delimiter_);
  // A comma inside a field of a table that is not divided by commas is a decimal comma.
  const auto all_numeric = [&](char point) {
    return std::all_of(first.begin(), first.end(), [point](const std::string& f) { return numeric(f, point); });
  };
  const bool decimal_comma = delimiter_ != ',' && !all_numeric('.') && all_numeric(',');
  const bool data = decimal_comma || all_numeric('.');
  header_line_ = lines_.line_number();
  fields_ = first.size();
  if (!data) {
    if (delimiter_ != ',') {  // only the first data line tells the decimal sign
      std::string_view row;
      while (lines_.next(row) && is_comment(row)) {
      }
      if (lines_.error()) return fail(*lines_.error());
      if (lines_.line_number() > header_line_ && !row.empty()) {
        const auto fields = split_fields(row, delimiter_);
        if (std::any_of(fields.begin(), fields.end(), [](const std::string& f) {
              return f.find(',') != std::string::npos && !numeric(f, '.') && numeric(f, ',');
            })) {
          point_ = ',';
        }
        lines_.put_back();
      }
    }
    return map_columns(file, first, false);
  }
  if (decimal_comma) point_ = ',';
  const bool by_number =
      !file.columns.empty() && std::all_of(file.columns.begin(), file.columns.end(),
                                           [](const auto& entry) { return column_number(entry.second).has_value(); });
  std::vector<std::string> names;
  if (!by_number && !comment.empty()) {
    names = split_fields(comment, guess_delimiter(comment));
    if (names.size() != first.size()) names.clear();
  }
  lines_.put_back();
  if (!names.empty()) {
    header_line_ = lines_.line_number();
    return map_columns(file, names, false);
  }
  return map_columns(file, std::vector<std::string>(first.size()), true);
}

// Gives each column of the file its name of Versine's, from [columns] or from the header itself.
Expected<void> TableReader::map_columns(const TableFile& file, const std::vector<std::string>& written, bool numbered) {
  written_ = written;
  header_.assign(written.size(), "");
  plan_.assign(written.size(), std::nullopt);
  if (numbered) {
    for (std::size_t i = 0; i < written_.size(); ++i) written_[i] = fmt::format("column {}", i + 1);
    if (file.columns.empty()) {
      return fail(
          {.file = name(),
           .line = header_line_,
           .found = fmt::format("{} numbers and no header", written.size()),
           .expected = "a header line that names the columns",
           .advice = "add one (time_s,gyro_x_radps,...), or give each column's number in [columns]: time_s = \"1\""});
    }
  } else {
    for (std::size_t i = 0; i < written.size(); ++i) header_[i] = normalized_column_name(written[i]);
  }
  for (const auto& [ours, theirs] : file.columns) {
    if (theirs.empty()) continue;  // present in the file or not: to be left alone
    std::optional<std::size_t> at;
    if (const auto n = column_number(theirs); n && numbered) {
      if (*n <= written.size()) at = *n - 1;
    } else if (!numbered) {
      for (std::size_t i = 0; i < written.size() && !at; ++i) {
        if (same_ignoring_case(written[i], theirs) || header_[i] == theirs) at = i;
      }
      if (!at && n && *n <= written.size()) at = *n - 1;
    }
    if (!at) {
      std::vector<std::string_view> names(written_.begin(), written_.end());
      const std::string_view close = nearest(theirs, names);
      return fail({.file = name(),
                   .line = header_line_,
                   .field = ours,
                   .found = numbered ? fmt::format("{} columns", written.size())
                                     : fmt::format("columns {}", fmt::join(written_, ", ")),
                   .expected = fmt::format("column '{}', as [columns] says", theirs),
                   .advice = close.empty() ? "correct [columns]: " + ours + " = \"NAME IN THE FILE\""
                                           : fmt::format("did you mean {} = \"{}\" in [columns]?", ours, close)});
    }
    header_[*at] = ours;
  }
  // A name given in [columns] wins over a column of the file that has the same name by itself.
  for (const auto& [ours, theirs] : file.columns) {
    for (std::size_t i = 0; i < header_.size(); ++i) {
      const bool mapped_here =
          !theirs.empty() && (same_ignoring_case(written[i], theirs) || column_number(theirs) == i + 1);
      if (split_column_name(header_[i]).base == split_column_name(ours).base && header_[i] != ours && !mapped_here) {
        header_[i].clear();
      }
    }
  }
  return {};
}

}  // namespace versine::io
