// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <charconv>
#include <functional>
#include <optional>
#include <string_view>

/// Small helpers of the fixed-layout field formats.
namespace versine::io {

inline std::string_view trimmed(std::string_view s) {
  const auto a = s.find_first_not_of(" \t\r\n");
  if (a == std::string_view::npos) return {};
  return s.substr(a, s.find_last_not_of(" \t\r\n") - a + 1);
}

inline std::optional<double> to_number(std::string_view s) {
  s = trimmed(s);
  if (!s.empty() && s.front() == '+') s.remove_prefix(1);
  double v = 0.0;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), v);
  if (s.empty() || error != std::errc() || end != s.data() + s.size()) return {};
  return v;
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
