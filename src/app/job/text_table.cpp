// SPDX-License-Identifier: Apache-2.0
#include "text_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "versine/core/numbers.hpp"
#include "versine/io/line_reader.hpp"

namespace versine::app {

namespace {
std::vector<std::string> fields(std::string_view line, char delimiter) {
  std::vector<std::string> out(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"') {
        out.back() += line[++i];
      } else {
        quoted = !quoted;
      }
    } else if (c == delimiter && !quoted) {
      out.emplace_back();
    } else {
      out.back() += c;
    }
  }
  return out;
}
}  // namespace

Expected<TextTable> TextTable::read(const std::filesystem::path& path, char delimiter,
                                    const std::function<bool(std::string_view)>& keep) {
  auto lines = io::LineReader::open(path);
  if (!lines) return tl::unexpected(lines.error());
  TextTable table;
  for (std::string_view line; lines->next(line);) {
    if (line.empty() || line.front() == '#') continue;
    if (table.header.empty()) {
      table.header = fields(line, delimiter);
      continue;
    }
    if (keep && !keep(line)) continue;
    auto row = fields(line, delimiter);
    if (row.size() < table.header.size()) {
      return fail({.file = path.string(),
                   .line = lines->line_number(),
                   .found = fmt::format("{} fields", row.size()),
                   .expected = fmt::format("{}, as in the header", table.header.size()),
                   .advice = "run the job again; the file was changed, or cut short while it was copied"});
    }
    table.rows.push_back(std::move(row));
  }
  if (lines->error()) return tl::unexpected(*lines->error());
  return table;
}

std::optional<std::size_t> TextTable::find(std::string_view column) const {
  const auto it = std::find(header.begin(), header.end(), column);
  if (it == header.end()) return std::nullopt;
  return static_cast<std::size_t>(it - header.begin());
}

double TextTable::number(const std::vector<std::string>& row, std::optional<std::size_t> column, char point) {
  if (!column || row[*column].empty()) return nan;
  std::string text = row[*column];
  std::replace(text.begin(), text.end(), point, '.');
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end == text.c_str() + text.size() ? value : nan;
}

}  // namespace versine::app
