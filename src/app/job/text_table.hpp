// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "versine/core/error.hpp"

namespace versine::app {

/// A small table of a result folder, as text. Lines that begin with '#' are passed over; quotes are understood.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;

  /// `keep` is asked for each raw line of data; empty: every line. A row with fewer fields than the header is an Error.
  [[nodiscard]] static Expected<TextTable> read(const std::filesystem::path& path, char delimiter = ',',
                                                const std::function<bool(std::string_view)>& keep = {});
  [[nodiscard]] std::optional<std::size_t> find(std::string_view column) const;
  /// The number in a field; NaN when the column is missing, or the field empty or no number.
  [[nodiscard]] static double number(const std::vector<std::string>& row, std::optional<std::size_t> column,
                                     char point = '.');
};

}  // namespace versine::app
