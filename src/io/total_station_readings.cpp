// SPDX-License-Identifier: Apache-2.0
#include "versine/io/total_station_readings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <set>

#include "field_text.hpp"
#include "text_output.hpp"
#include "time_columns.hpp"
#include "versine/core/units.hpp"
#include "versine/io/table_reader.hpp"

namespace versine::io {
namespace {

using stationing::Face;
using stationing::Sighting;
using stationing::Stationing;
using Slot = TableReader::Slot;

/// The columns of a CSV of readings.
struct Columns {
  Slot station, direction, zenith, distance;
  std::optional<Slot> point, mark, face, set, pressure, humidity, prism;
  std::optional<Slot> instrument_height, target_height, temperature;
  std::optional<TimeColumns> from, to;
};

Expected<Columns> bind(TableReader& table, const Clock& clock) {
  Columns c{};
  const auto station = table.find_text("station");
  if (!station) {
    return fail({.file = table.name(),
                 .line = table.line_number(),
                 .field = "station",
                 .found = "no such column",
                 .expected = "the name of the stationing in each row",
                 .advice = "map the column in [columns], or see docs/formats/total-station.md"});
  }
  c.station = *station;
  for (const auto& [slot, name, quantity] : {std::tuple{&c.direction, "direction", Quantity::angle},
                                             {&c.zenith, "zenith", Quantity::angle},
                                             {&c.distance, "distance", Quantity::length}}) {
    const auto found = table.need(name, quantity);
    if (!found) return tl::unexpected(found.error());
    *slot = *found;
  }
  for (const auto& [slot, name, quantity] : {std::tuple{&c.instrument_height, "instrument_height", Quantity::length},
                                             {&c.target_height, "target_height", Quantity::length},
                                             {&c.prism, "prism_constant", Quantity::length},
                                             {&c.temperature, "temperature", Quantity::temperature}}) {
    const auto found = table.find(name, quantity);
    if (!found) return tl::unexpected(found.error());
    *slot = *found;
  }
  c.point = table.find_text("point");
  c.mark = table.find_text("mark");
  c.face = table.find_text("face");
  c.set = table.find_text("set");
  c.pressure = table.find_text("pressure_hpa");
  c.humidity = table.find_text("humidity_percent");
  for (const auto& [slot, name] : {std::pair{&c.from, "time_from"}, {&c.to, "time_to"}}) {
    if (!table.has(name)) continue;
    auto found = TimeColumns::bind(table, clock, name);
    if (!found) return tl::unexpected(found.error());
    *slot = std::move(*found);
  }
  return c;
}

Expected<double> plain(const TableReader& table, const std::optional<Slot>& slot, double otherwise,
                       std::string_view expected) {
  if (!slot || trimmed(table.text(*slot)).empty()) return otherwise;
  const auto value = to_number(table.text(*slot));
  if (!value) {
    return fail(
        table.complaint(*slot, fmt::format("'{}'", table.text(*slot)), std::string(expected), "correct the line"));
  }
  return *value;
}

double number_or(const TableReader& table, const std::optional<Slot>& slot, double otherwise) {
  if (!slot || std::isnan(table.number(*slot))) return otherwise;
  return table.number(*slot);
}

Expected<Sighting> sighting(const TableReader& table, const Columns& c) {
  Sighting s{.point = c.point ? std::string(trimmed(table.text(*c.point))) : "",
             .direction = table.number(c.direction),
             .zenith = table.number(c.zenith),
             .distance = table.number(c.distance),
             .target_height = number_or(table, c.target_height, 0.0),
             .prism_constant = number_or(table, c.prism, 0.0),
             .line = table.line_number()};
  for (const Slot slot : {c.direction, c.zenith}) {
    if (std::isnan(table.number(slot))) {
      return fail(table.complaint(slot, "nothing", "an angle", "remove rows that hold no reading"));
    }
  }
  const auto face = plain(table, c.face, s.zenith > std::numbers::pi ? 2.0 : 1.0, "1 or 2");
  if (!face) return tl::unexpected(face.error());
  const auto set = plain(table, c.set, 0.0, "a whole number");
  if (!set) return tl::unexpected(set.error());
  s.face = *face == 2.0 ? Face::two : Face::one;
  s.set = static_cast<int>(*set);
  if ((s.face == Face::two) != (s.zenith > std::numbers::pi)) {
    return fail(table.complaint(
        c.zenith, fmt::format("a zenith angle of {:.4f} gon in face {}", s.zenith / units::gon, *face),
        "0 to 200 gon in face 1, 200 to 400 gon in face 2", "is the column's unit right (gon, degrees)? Is the face?"));
  }
  return s;
}

Expected<FieldBook> read_csv(LineReader lines, const TableFile& file) {
  auto opened = TableReader::open(std::move(lines), file);
  if (!opened) return tl::unexpected(opened.error());
  TableReader& table = *opened;
  auto c = bind(table, file.clock);
  if (!c) return tl::unexpected(c.error());
  FieldBook book;
  std::set<std::string> names;
  while (table.next()) {
    const std::string name(trimmed(table.text(c->station)));
    if (book.stationings.empty() || book.stationings.back().name != name) {
      if (!names.insert(name).second) {
        return fail(table.complaint(c->station, fmt::format("station '{}' once more", name),
                                    "the rows of a station one after another",
                                    "give the second occupation its own name, " + name + "b"));
      }
      book.stationings.push_back({.name = name});
      Stationing& s = book.stationings.back();
      if (c->mark) s.mark = std::string(trimmed(table.text(*c->mark)));
      s.instrument_height = number_or(table, c->instrument_height, 0.0);
      const auto pressure = plain(table, c->pressure, NAN, "a pressure in hPa");
      const auto humidity = plain(table, c->humidity, 60.0, "a humidity in percent");
      if (!pressure || !humidity) return tl::unexpected(pressure ? humidity.error() : pressure.error());
      if (!std::isnan(*pressure) && c->temperature) {
        s.atmosphere = stationing::Atmosphere{table.number(*c->temperature), *pressure, *humidity / 100.0};
      }
    }
    auto s = sighting(table, *c);
    if (!s) return tl::unexpected(s.error());
    for (const auto& [columns, at] : {std::pair{&c->from, &Sighting::from}, {&c->to, &Sighting::to}}) {
      if (!*columns) continue;
      const auto time = (*columns)->read(table);
      if (!time) return tl::unexpected(time.error());
      (*s).*at = *time;
    }
    Stationing& station = book.stationings.back();
    if (s->from && (!station.from || *s->from < *station.from)) station.from = s->from;
    if (s->to && (!station.to || *s->to > *station.to)) station.to = s->to;
    station.sightings.push_back(std::move(*s));
  }
  if (table.error()) return fail(*table.error());
  if (auto fine = table.faults().tolerable(table.name(), table.rows()); !fine) return tl::unexpected(fine.error());
  return book;
}

bool looks_like_a_field_book(std::string_view start) {
  start = trimmed(start);
  return start.starts_with('*') || start.starts_with('{') || start.starts_with("00NM") ||
         (start.size() > 7 && start.substr(0, 2).find_first_not_of("0123456789") == std::string_view::npos &&
          start.find_first_of("+-,;") == 6);
}

}  // namespace

Expected<FieldBook> read_total_station(const TableFile& file) {
  auto text = read_text(file.path);
  if (!text) return tl::unexpected(text.error());
  if (looks_like_a_field_book(std::string_view(*text).substr(0, 100)))
    return parse_field_book(*text, file.path.string());
  return read_csv(LineReader::from_text(std::move(*text), file.path.string()), file);
}

Expected<void> write_total_station(const std::filesystem::path& path, std::span<const Stationing> stationings) {
  TextOutput out(path);
  out.text(
      "station,point,time_from_s,time_to_s,direction_gon,zenith_gon,distance_m,face,set,instrument_height_m,"
      "target_height_m,prism_constant_mm\n");
  const auto seconds = [](const std::optional<Time>& t) { return t ? seconds_text(*t) : std::string(); };
  for (const Stationing& s : stationings) {
    for (const Sighting& r : s.sightings) {
      const double direction =
          r.direction - 2.0 * std::numbers::pi * std::floor(r.direction / (2.0 * std::numbers::pi));
      out.print("{},{},{},{},{:.7f},{:.7f},{},{},{},{:.4f},{:.4f},{:.3f}\n", s.name, r.point,
                seconds(r.from ? r.from : s.from), seconds(r.to ? r.to : s.to), direction / units::gon,
                r.zenith / units::gon, std::isnan(r.distance) ? "" : fmt::format("{:.6f}", r.distance),
                r.face == Face::one ? 1 : 2, r.set > 0 ? fmt::format("{}", r.set) : "", s.instrument_height,
                r.target_height, r.prism_constant * 1e3);
    }
  }
  return out.close();
}

}  // namespace versine::io
