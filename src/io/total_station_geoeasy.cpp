// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "field_text.hpp"
#include "versine/io/total_station_formats.hpp"

namespace versine::io {
namespace {

/// Items of one line: {code value}.
Expected<std::map<int, std::string>> items(std::string_view line, const std::string& name, std::size_t number) {
  std::map<int, std::string> found;
  while (!(line = trimmed(line)).empty()) {
    const auto close = line.find('}');
    const auto gap = line.find(' ');
    const auto code = gap == std::string_view::npos ? std::nullopt : to_number(line.substr(1, gap - 1));
    if (line.front() != '{' || close == std::string_view::npos || gap > close || !code) {
      return fail({.file = name,
                   .line = number,
                   .field = "GeoEasy record",
                   .found = fmt::format("'{}'", line.substr(0, 40)),
                   .expected = "items {code value}",
                   .advice = "export the observations from GeoEasy again"});
    }
    found[static_cast<int>(*code)] = std::string(trimmed(line.substr(gap, close - gap)));
    line.remove_prefix(close + 1);
  }
  return found;
}

}  // namespace

Expected<FieldBook> parse_geoeasy(std::string_view text, const std::string& name) {
  FieldBook book;
  std::map<std::string, int> occupied;
  std::optional<Error> error;
  for_each_line(text, [&](std::string_view line, std::size_t number) {
    auto record = items(line, name, number);
    if (!record) {
      error = record.error();
      return false;
    }
    const auto value = [&](int code) -> std::optional<double> {
      const auto it = record->find(code);
      return it == record->end() ? std::nullopt : to_number(it->second);
    };
    if (const auto station = record->find(2); station != record->end()) {
      const int times = ++occupied[station->second];
      book.stationings.push_back({.name = times == 1 ? station->second : fmt::format("{}#{}", station->second, times),
                                  .mark = station->second});
      book.stationings.back().instrument_height = value(3).value_or(0.0);
    } else if (record->contains(5) && (record->contains(37) || record->contains(38))) {
      book.coordinates.push_back(
          {record->at(5),
           {value(38).value_or(std::nan("")), value(37).value_or(std::nan("")), value(39).value_or(std::nan(""))},
           number});
    } else if (record->contains(5) && value(7) && value(8) && !book.stationings.empty()) {
      stationing::Sighting s{.point = record->at(5),
                             .direction = *value(7),
                             .zenith = *value(8),
                             .distance = value(9).value_or(std::nan("")),
                             .target_height = value(6).value_or(0.0),
                             .line = number};
      s.face = s.zenith > std::numbers::pi ? stationing::Face::two : stationing::Face::one;
      book.stationings.back().sightings.push_back(s);
    } else if (record->contains(5)) {  // a direction or a horizontal distance alone cannot place a station in space
      book.warnings.push_back(fmt::format("line {}: {} has no zenith angle and was left out", number, record->at(5)));
    }
    return true;
  });
  if (error) return fail(std::move(*error));
  return book;
}

Expected<FieldBook> parse_field_book(std::string_view text, const std::string& name) {
  const std::string_view start = trimmed(text.substr(0, 200));
  if (start.starts_with("*1") || start.starts_with("*4") ||
      (start.size() > 7 && (start.starts_with("11") || start.starts_with("41")) && start.find_first_of("+-") == 6)) {
    return parse_gsi(text, name);
  }
  if (start.starts_with("00")) return parse_sdr(text, name);
  if (start.starts_with("{")) return parse_geoeasy(text, name);
  return fail({.file = name,
               .line = 1,
               .field = "field book",
               .found = fmt::format("'{}'", start.substr(0, 30)),
               .expected = "Leica GSI-8 or GSI-16, Sokkia SDR33 or GeoEasy",
               .advice = "export one of these, or write CSV as docs/formats/total-station.md tells"});
}

}  // namespace versine::io
