// SPDX-License-Identifier: Apache-2.0
#include "versine/io/journey_brussels.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>

#include "field_text.hpp"
#include "file_bytes.hpp"
#include "versine/core/units.hpp"

namespace versine::io {

namespace {

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> out;
  if (line.ends_with('\r')) line.remove_suffix(1);
  for (std::size_t from = 0; from <= line.size();) {
    const std::size_t to = std::min(line.find(',', from), line.size());
    out.push_back(line.substr(from, to - from));
    from = to + 1;
  }
  return out;
}

/// 2022-01-14T10:45:25.400 as UTC; the fraction may be missing.
std::optional<Time> iso_time(std::string_view t) {
  if (t.size() < 19 || t[4] != '-' || t[7] != '-' || t[13] != ':' || t[16] != ':') return std::nullopt;
  const auto part = [&](std::size_t at, std::size_t n) { return number(t.substr(at, n)); };
  const auto year = part(0, 4), month = part(5, 2), day = part(8, 2), hour = part(11, 2), minute = part(14, 2);
  std::string_view rest = t.substr(17);
  if (rest.ends_with('Z')) rest.remove_suffix(1);
  const auto second = number(rest);
  if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(*year)),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok() || *hour > 23 || *minute > 59 || *second >= 61.0) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  const auto minutes = (static_cast<std::int64_t>(days) * 24 + std::llround(*hour)) * 60 + std::llround(*minute);
  return Time{minutes * 60'000'000'000 + std::llround(*second * 1e9)};
}

sensors::FixType fix_type(std::string_view word) {
  using F = sensors::FixType;
  if (word.starts_with("NARROW_INT") || word.starts_with("L1_INT") || word.starts_with("WIDE_INT")) return F::fixed;
  if (word.ends_with("_FLOAT")) return F::float_ambiguity;
  if (word == "PSRDIFF" || word == "WAAS" || word == "DGPS") return F::differential;
  if (word == "PROPAGATED") return F::dead_reckoned;
  if (word == "NONE") return F::none;
  return F::single;
}

}  // namespace

Expected<georef::Recording> read_brussels_log(const std::filesystem::path& path) {
  const auto bytes = file_bytes(path);
  if (!bytes) return tl::unexpected(bytes.error());
  std::string_view rest = *bytes;
  const auto next_line = [&] {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const auto line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return line;
  };
  constexpr std::array<std::string_view, 4> names{"timestamp", "latitude", "longitude", "position_type"};
  std::array<std::size_t, 4> column{};
  const auto header = cells_of(next_line());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto it = std::find(header.begin(), header.end(), names[i]);
    if (it == header.end()) {
      return fail({.file = path.string(),
                   .line = 1,
                   .field = std::string(names[i]),
                   .found = "no such column",
                   .expected = "timestamp, latitude, longitude, position_type",
                   .advice = "keep the file's header line"});
    }
    column[i] = static_cast<std::size_t>(it - header.begin());
  }
  georef::Recording out;
  out.name = path.string();
  out.gnss.scale = TimeScale::utc;
  for (std::size_t line_number = 2; !rest.empty(); ++line_number) {
    const auto line = next_line();
    if (line.empty() || line == "\r") continue;
    const auto cells = cells_of(line);
    const auto wrong = [&](std::size_t i, std::string_view expected) {
      return fail({.file = path.string(),
                   .line = line_number,
                   .field = std::string(names[i]),
                   .found = column[i] < cells.size() ? fmt::format("'{}'", cells[column[i]]) : "a line cut short",
                   .expected = std::string(expected),
                   .advice = "mend or remove the line"});
    };
    if (cells.size() <= *std::max_element(column.begin(), column.end())) return wrong(3, "a cell for each column");
    const auto time = iso_time(cells[column[0]]);
    const auto latitude = number(cells[column[1]]), longitude = number(cells[column[2]]);
    if (!time) return wrong(0, "a time as 2022-01-14T10:45:25.400");
    if (!latitude || std::abs(*latitude) > 90.0) return wrong(1, "a latitude in degrees");
    if (!longitude || std::abs(*longitude) > 180.0) return wrong(2, "a longitude in degrees");
    georef::Fix fix;
    fix.time = *time;
    fix.position = {*latitude * units::deg, *longitude * units::deg, 0.0};
    fix.type = fix_type(cells[column[3]]);
    out.gnss.samples.push_back(fix);
  }
  return out;
}

}  // namespace versine::io
