// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

/// Column names of text tables: what is measured, and behind the last '_' its unit.
namespace versine::io {

enum class Quantity {
  none,  ///< counts, codes, words
  time,
  length,
  angle,
  angular_rate,
  speed,  ///< and increments of velocity
  acceleration,
  temperature,
};

/// A unit as a suffix of a column's name.
struct Unit {
  std::string_view suffix;  ///< "degps"
  Quantity quantity;
  double factor;          ///< to SI and radians
  std::string_view text;  ///< "deg/s"
};

/// All units that are understood.
[[nodiscard]] std::span<const Unit> units();
/// The suffixes of a quantity, joined by ", ", for messages.
[[nodiscard]] std::string suffixes(Quantity quantity);

/// A column's name taken apart: "gyro_x_degps" is "gyro_x" in deg/s. `unit` is null without a known suffix.
struct ColumnName {
  std::string base;
  const Unit* unit = nullptr;
};
[[nodiscard]] ColumnName split_column_name(std::string_view name);

/// A header as written by others brought to the form of Versine's names: lower case, '_' between words, units in
/// brackets as suffixes, usual short forms spelled out. "Latitude (deg)" is "latitude_deg", "gyr x [rad/s]" is
/// "gyro_x_radps".
[[nodiscard]] std::string normalized_column_name(std::string_view header);

}  // namespace versine::io
