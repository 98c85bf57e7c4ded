// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace versine::io {

/// Blanks at both ends taken off.
[[nodiscard]] inline std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Fields of a line, without blanks around them and without quotes; `delimiter` ' ' means any run of blanks and tabs.
/// A delimiter at the very end adds no field.
[[nodiscard]] std::vector<std::string> split_fields(std::string_view line, char delimiter);

}  // namespace versine::io
