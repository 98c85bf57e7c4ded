// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/geodesy/projection.hpp"
#include "versine/stationing/readings.hpp"

/// Field books of total stations, as the instruments write them. Each parser takes the file's content and its name for
/// messages; every unit is the file's own and leaves in SI and radians.
namespace versine::io {

/// A point with map coordinates out of a field book or a list.
struct CoordinateEntry {
  std::string name;
  geodesy::MapPoint map;  ///< height NaN: not told
  std::size_t line = 0;
};

struct FieldBook {
  std::vector<stationing::Stationing> stationings;
  std::vector<CoordinateEntry> coordinates;
  std::vector<std::string> warnings;
};

/// Leica GSI-8 and GSI-16. Words: 11 point, 21 direction, 22 zenith angle, 31 slope distance, 42 station, 43 and 88
/// instrument height, 51 ppm and prism constant, 58 prism constant, 87 target height, 41 code block with 42 and 43 (or
/// 84 to 86) opens a station, 81 to 83 coordinates. Units by the digit in each word: metres or feet with 3 to 5
/// decimals, gon, degrees (decimal or sexagesimal), mil.
[[nodiscard]] Expected<FieldBook> parse_gsi(std::string_view text, const std::string& name);

/// Sokkia SDR33 (14-character and SDR20/2x 4-character point numbers): 00 header with units, 02 station, 03 target
/// height, 08 coordinates, 09 observations in face 1 and 2.
[[nodiscard]] Expected<FieldBook> parse_sdr(std::string_view text, const std::string& name);

/// GeoEasy observations (.geo) and coordinates (.coo): one record a line, items {code value}; angles in radians.
[[nodiscard]] Expected<FieldBook> parse_geoeasy(std::string_view text, const std::string& name);

/// By the content: GSI, SDR or GeoEasy. Fails naming what was tried.
[[nodiscard]] Expected<FieldBook> parse_field_book(std::string_view text, const std::string& name);

}  // namespace versine::io
