// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "field_text.hpp"
#include "versine/core/units.hpp"
#include "versine/io/total_station_formats.hpp"

namespace versine::io {
namespace {

using stationing::Face;
using stationing::Sighting;

/// Widths and units, from the header (Nikon and Sokkia manuals, "SDR2x and SDR33 record formats").
struct Layout {
  std::size_t point = 16, number = 16;
  double angle = units::deg, length = 1.0;
  bool east_first = false;
};

std::string_view field(std::string_view line, std::size_t from, std::size_t width) {
  return from >= line.size() ? std::string_view{} : trimmed(line.substr(from, width));
}

Error complaint(const std::string& name, std::size_t line, std::string found, std::string expected) {
  return {.file = name,
          .line = line,
          .field = "SDR record",
          .found = std::move(found),
          .expected = std::move(expected),
          .advice = "export the job again as SDR33 with raw observations"};
}

Expected<Layout> header(std::string_view line, const std::string& name, std::size_t number) {
  Layout l;
  if (line.find("SDR33") == std::string_view::npos) l.point = 4, l.number = 10;
  const char angle = line.size() > 40 ? line[40] : ' ', length = line.size() > 41 ? line[41] : ' ';
  if (angle == '1')
    l.angle = units::deg;
  else if (angle == '2')
    l.angle = units::gon;
  else if (angle == '4')
    l.angle = 2.0 * std::numbers::pi / 6400.0;
  else
    return fail(
        complaint(name, number, fmt::format("angle unit '{}'", angle), "1 (degrees), 2 (gon) or 4 (mil) in column 41"));
  if (length != '1' && length != '2') {
    return fail(
        complaint(name, number, fmt::format("distance unit '{}'", length), "1 (metres) or 2 (feet) in column 42"));
  }
  l.length = length == '1' ? 1.0 : 0.3048;
  l.east_first = line.size() > 44 && line[44] == '2';
  return l;
}

}  // namespace

Expected<FieldBook> parse_sdr(std::string_view text, const std::string& name) {
  FieldBook book;
  Layout l;
  bool started = false;
  double target_height = 0.0;
  std::map<std::string, int> occupied;
  std::optional<Error> error;
  const auto coordinates = [&](std::string_view line, std::size_t number) {
    CoordinateEntry p{.name = std::string(field(line, 4, l.point)), .line = number};
    const auto first = to_number(field(line, 4 + l.point, l.number));
    const auto second = to_number(field(line, 4 + l.point + l.number, l.number));
    const auto height = to_number(field(line, 4 + l.point + 2 * l.number, l.number));
    if (!first || !second) return;
    p.map = {l.length * (l.east_first ? *first : *second), l.length * (l.east_first ? *second : *first),
             height ? l.length * *height : std::numeric_limits<double>::quiet_NaN()};
    book.coordinates.push_back(p);
  };
  for_each_line(text, [&](std::string_view line, std::size_t number) {
    const std::string_view kind = line.substr(0, 2);
    if (kind == "00") {
      auto h = header(line, name, number);
      if (!h) {
        error = h.error();
        return false;
      }
      l = *h;
      started = true;
    } else if (kind == "02") {
      coordinates(line, number);
      const std::string station(field(line, 4, l.point));
      const int times = ++occupied[station];
      book.stationings.push_back(
          {.name = times == 1 ? station : fmt::format("{}#{}", station, times), .mark = station});
      const auto h = to_number(field(line, 4 + l.point + 3 * l.number, l.number));
      book.stationings.back().instrument_height = h ? *h * l.length : 0.0;
    } else if (kind == "03") {
      target_height = to_number(field(line, 4, l.number)).value_or(0.0) * l.length;
    } else if (kind == "08") {
      coordinates(line, number);
    } else if (kind == "09") {
      const auto distance = to_number(field(line, 4 + 2 * l.point, l.number));
      const auto zenith = to_number(field(line, 4 + 2 * l.point + l.number, l.number));
      const auto direction = to_number(field(line, 4 + 2 * l.point + 2 * l.number, l.number));
      if (!zenith || !direction || book.stationings.empty()) {
        error = complaint(name, number, fmt::format("'{}'", line.substr(0, 90)),
                          "a station record before it, and numbers for both angles");
        return false;
      }
      Sighting s{.point = std::string(field(line, 4 + l.point, l.point)),
                 .direction = *direction * l.angle,
                 .zenith = *zenith * l.angle,
                 .target_height = target_height,
                 .line = number};
      if (distance && *distance > 0.0) s.distance = *distance * l.length;
      s.face = s.zenith > std::numbers::pi ? Face::two : Face::one;
      book.stationings.back().sightings.push_back(s);
    }
    return true;
  });
  if (error) return fail(std::move(*error));
  if (!started) return fail(complaint(name, 1, "no header record", "a first record that begins with 00NM"));
  return book;
}

}  // namespace versine::io
