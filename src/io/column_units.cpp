// SPDX-License-Identifier: Apache-2.0
#include "versine/io/column_units.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "versine/core/units.hpp"

namespace versine::io {

namespace {
using Q = Quantity;
namespace u = units;
constexpr double g = u::standard_gravity;

constexpr std::array all_units{
    Unit{"s", Q::time, 1.0, "s"},
    Unit{"ms", Q::time, 1e-3, "ms"},
    Unit{"us", Q::time, 1e-6, "us"},
    Unit{"ns", Q::time, 1e-9, "ns"},
    Unit{"m", Q::length, 1.0, "m"},
    Unit{"km", Q::length, u::km, "km"},
    Unit{"cm", Q::length, 1e-2, "cm"},
    Unit{"mm", Q::length, u::mm, "mm"},
    Unit{"rad", Q::angle, 1.0, "rad"},
    Unit{"mrad", Q::angle, 1e-3, "mrad"},
    Unit{"deg", Q::angle, u::deg, "deg"},
    Unit{"arcmin", Q::angle, u::deg / 60.0, "arcmin"},
    Unit{"arcsec", Q::angle, u::arcsec, "arcsec"},
    Unit{"gon", Q::angle, u::gon, "gon"},
    Unit{"radps", Q::angular_rate, 1.0, "rad/s"},
    Unit{"mradps", Q::angular_rate, 1e-3, "mrad/s"},
    Unit{"degps", Q::angular_rate, u::deg, "deg/s"},
    Unit{"dps", Q::angular_rate, u::deg, "deg/s"},
    Unit{"degph", Q::angular_rate, u::deg_per_hour, "deg/h"},
    Unit{"arcsecps", Q::angular_rate, u::arcsec, "arcsec/s"},
    Unit{"mps", Q::speed, 1.0, "m/s"},
    Unit{"mmps", Q::speed, u::mm, "mm/s"},
    Unit{"kmh", Q::speed, u::kmh, "km/h"},
    Unit{"kmph", Q::speed, u::kmh, "km/h"},
    Unit{"knots", Q::speed, 1852.0 / 3600.0, "knots"},
    Unit{"gs", Q::speed, g, "g s"},
    Unit{"mgs", Q::speed, 1e-3 * g, "mg s"},
    Unit{"ugs", Q::speed, 1e-6 * g, "ug s"},
    Unit{"mps2", Q::acceleration, 1.0, "m/s^2"},
    Unit{"g", Q::acceleration, g, "g"},
    Unit{"mg", Q::acceleration, 1e-3 * g, "mg"},
    Unit{"ug", Q::acceleration, 1e-6 * g, "ug"},
    Unit{"degc", Q::temperature, 1.0, "deg C"},
};

// How units are written in brackets elsewhere.
constexpr std::array<std::pair<std::string_view, std::string_view>, 13> bracket_units{{
    {"rad/s", "radps"},
    {"deg/s", "degps"},
    {"deg/h", "degph"},
    {"\xc2\xb0/s", "degps"},
    {"\xc2\xb0/h", "degph"},
    {"\xc2\xb0", "deg"},
    {"degrees", "deg"},
    {"m/s^2", "mps2"},
    {"m/s2", "mps2"},
    {"m/s\xc2\xb2", "mps2"},
    {"m/s", "mps"},
    {"km/h", "kmh"},
    {"\xc2\xb0"
     "c",
     "degc"},
}};

// Short forms of words that are common enough to be understood.
constexpr std::array<std::pair<std::string_view, std::string_view>, 14> short_forms{{
    {"acc", "accel"},
    {"accelerometer", "accel"},
    {"gyr", "gyro"},
    {"lat", "latitude"},
    {"lon", "longitude"},
    {"lng", "longitude"},
    {"long", "longitude"},
    {"h", "height"},
    {"altitude", "height"},
    {"alt", "height"},
    {"vel", "velocity"},
    {"std", "sigma"},
    {"sd", "sigma"},
    {"yaw", "heading"},
}};

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return out;
}

// Letters, digits and bytes of UTF-8; anything else becomes one '_' between words.
std::string words(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool keep = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || static_cast<unsigned char>(c) >= 0x80;
    if (keep) {
      out += c;
    } else if (!out.empty() && out.back() != '_') {
      out += '_';
    }
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out;
}

std::string spelled_out(std::string_view name) {
  std::string out;
  while (!name.empty()) {
    const std::size_t n = std::min(name.find('_'), name.size());
    std::string_view word = name.substr(0, n);
    for (const auto& [from, to] : short_forms) {
      if (word == from) {
        word = to;
        break;
      }
    }
    if (!out.empty()) out += '_';
    out += word;
    name.remove_prefix(std::min(n + 1, name.size()));
  }
  return out;
}
}  // namespace

std::span<const Unit> units() {
  return all_units;
}

std::string suffixes(Quantity quantity) {
  std::string text;
  for (const Unit& unit : all_units) {
    if (unit.quantity != quantity) continue;
    text += (text.empty() ? "_" : ", _") + std::string(unit.suffix);
  }
  return text;
}

ColumnName split_column_name(std::string_view name) {
  const std::size_t at = name.rfind('_');
  if (at != std::string_view::npos && at > 0) {
    const std::string suffix = lower(name.substr(at + 1));
    for (const Unit& unit : all_units) {
      if (suffix == unit.suffix) return {std::string(name.substr(0, at)), &unit};
    }
  }
  return {std::string(name), nullptr};
}

std::string normalized_column_name(std::string_view header) {
  std::string text = lower(header);
  std::string unit;
  const std::size_t open = text.find_first_of("[(");
  if (open != std::string::npos) {
    const std::size_t close = text.find_first_of("])", open);
    unit = text.substr(open + 1, close == std::string::npos ? close : close - open - 1);
    text.resize(open);
    for (const auto& [from, to] : bracket_units) {
      if (unit == from) unit = to;
    }
  }
  std::string name = spelled_out(words(text));
  if (!unit.empty()) name += "_" + words(unit);
  return name;
}

}  // namespace versine::io
