// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>

/// Fields of text formats.
namespace versine::io {

inline std::string_view trimmed(std::string_view s) {
  const auto a = s.find_first_not_of(" \t\r\n");
  if (a == std::string_view::npos) return {};
  return s.substr(a, s.find_last_not_of(" \t\r\n") - a + 1);
}

/// A field that is one finite number and nothing else.
inline std::optional<double> number(std::string_view field) {
  double x = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), x);
  if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(x)) return std::nullopt;
  return x;
}

/// A number with a plus sign and blanks around it, as instruments write it.
inline std::optional<double> to_number(std::string_view s) {
  s = trimmed(s);
  if (!s.empty() && s.front() == '+') s.remove_prefix(1);
  return number(s);
}

/// Calls `body(line, number)` for each line, counted from 1, until it returns false.
inline void for_each_line(std::string_view text, const std::function<bool(std::string_view, std::size_t)>& body) {
  std::size_t number = 0;
  while (!text.empty()) {
    const auto end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (!body(line, ++number)) return;
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
}

}  // namespace versine::io
