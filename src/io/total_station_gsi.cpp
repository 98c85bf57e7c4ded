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

/// One word: `21.322+0000000016901313` is word 21, information "322", value with sign.
struct Word {
  int index = 0;
  char unit = ' ';
  bool negative = false;
  std::string_view digits;  ///< as written, letters and leading zeros included
};

std::optional<Word> word_of(std::string_view text) {
  if (text.size() < 8) return {};
  const std::size_t sign = text.find_first_of("+-", 6);
  if (sign != 6) return {};
  const auto index = to_number(text.substr(0, 2));
  if (!index) return {};
  return Word{static_cast<int>(*index), text[5], text[sign] == '-', text.substr(sign + 1)};
}

std::string label(std::string_view digits) {
  const auto first = digits.find_first_not_of('0');
  return first == std::string_view::npos ? std::string(digits.empty() ? "" : "0")
                                         : std::string(trimmed(digits.substr(first)));
}

/// The value in SI or radians; nothing for words without a number ("-----").
std::optional<double> value_of(const Word& w) {
  const auto raw = to_number(w.digits);
  if (!raw) return {};
  const double x = w.negative ? -*raw : *raw;
  switch (w.unit) {
    case '0':
      return x * 1e-3;
    case '1':
      return x * 1e-3 * 0.3048;
    case '2':
      return x * 1e-5 * units::gon;
    case '3':
      return x * 1e-5 * units::deg;
    case '4': {  // dddmmsss: seconds with one decimal
      const double a = std::abs(x), d = std::floor(a / 1e5), m = std::floor(std::fmod(a, 1e5) / 1e3);
      return std::copysign((d + m / 60.0 + std::fmod(a, 1e3) / 10.0 / 3600.0) * units::deg, x);
    }
    case '5':
      return x * 1e-4 * 2.0 * std::numbers::pi / 6400.0;
    case '6':
      return x * 1e-4;
    case '7':
      return x * 1e-4 * 0.3048;
    case '8':
      return x * 1e-5;
    default:
      return x * 1e-3;  // some instruments leave the unit of heights open: they mean millimetres
  }
}

/// State of the file while it is read.
struct Reading {
  const std::string& name;
  FieldBook book;
  double target_height = 0.0;
  double prism_constant = 0.0;
  std::map<std::string, int> occupied;  ///< how often a station was set up

  stationing::Stationing& station() {
    if (book.stationings.empty()) book.stationings.push_back({.name = "station"});
    return book.stationings.back();
  }
  void open(const std::string& station) {
    const int times = ++occupied[station];
    book.stationings.push_back({.name = times == 1 ? station : fmt::format("{}#{}", station, times), .mark = station});
  }
};

Error complaint(const Reading& r, std::size_t line, std::string found, std::string expected) {
  return {.file = r.name,
          .line = line,
          .field = "GSI block",
          .found = std::move(found),
          .expected = std::move(expected),
          .advice = "export the job again as GSI-8 or GSI-16 polar data"};
}

Expected<void> take_block(Reading& r, const std::vector<Word>& words, std::size_t line) {
  Sighting s{.target_height = r.target_height, .prism_constant = r.prism_constant, .line = line};
  bool direction = false, zenith = false, coordinates = false;
  CoordinateEntry point{.map = {.height = std::numeric_limits<double>::quiet_NaN()}, .line = line};
  for (const Word& w : words) {
    const auto value = value_of(w);
    const bool angle = w.index == 21 || w.index == 22;
    if (angle && (!value || w.unit < '2' || w.unit > '5')) {
      return fail(complaint(r, line, fmt::format("word {} '{}' with unit digit '{}'", w.index, w.digits, w.unit),
                            "an angle with unit digit 2 to 5 (gon, degrees, mil)"));
    }
    switch (w.index) {
      case 11:
        s.point = point.name = label(w.digits);
        break;
      case 21:
        s.direction = *value, direction = true;
        break;
      case 22:
        s.zenith = *value, zenith = true;
        break;
      case 31:
        s.distance = value && *value > 0.0 ? *value : s.distance;
        break;
      case 42:
        r.open(label(w.digits));
        break;
      case 43:
      case 88:
        if (value) r.station().instrument_height = *value;
        break;
      case 87:
        if (value) s.target_height = r.target_height = *value;
        break;
      // 51 and 58 tell what the instrument has applied already: nothing is left to add.
      case 81:
        if (value) point.map.easting = *value, coordinates = true;
        break;
      case 82:
        if (value) point.map.northing = *value;
        break;
      case 83:
        if (value) point.map.height = *value;
        break;
      default:
        break;
    }
  }
  if (direction != zenith) return fail(complaint(r, line, "only one of the two angles", "words 21 and 22 together"));
  if (direction) {
    s.face = s.zenith > std::numbers::pi ? Face::two : Face::one;
    r.station().sightings.push_back(s);
  }
  if (coordinates) r.book.coordinates.push_back(point);
  return {};
}

}  // namespace

Expected<FieldBook> parse_gsi(std::string_view text, const std::string& name) {
  Reading r{.name = name};
  std::optional<Error> error;
  for_each_line(text, [&](std::string_view line, std::size_t number) {
    line = trimmed(line);
    if (line.empty()) return true;
    const bool wide = line.front() == '*';
    if (wide) line.remove_prefix(1);
    const std::size_t width = wide ? 23 : 15;
    std::vector<Word> words;
    while (!trimmed(line).empty()) {
      const auto word = word_of(line.substr(0, width));
      if (!word || (line.size() < width && line.size() + 1 < width)) {
        error = complaint(r, number, fmt::format("'{}'", line.substr(0, width)),
                          fmt::format("a word of {} characters: two digits, information, sign, data", width));
        return false;
      }
      words.push_back(*word);
      line.remove_prefix(std::min(width, line.size()));
      while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
    }
    if (auto done = take_block(r, words, number); !done) error = done.error();
    return !error;
  });
  if (error) return fail(std::move(*error));
  if (r.book.stationings.empty() && r.book.coordinates.empty()) {
    return fail({.file = name,
                 .found = "no measurement and no coordinates",
                 .expected = "GSI blocks",
                 .advice = "export the job again as GSI-8 or GSI-16"});
  }
  return std::move(r.book);
}

}  // namespace versine::io
