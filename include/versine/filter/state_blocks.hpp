// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace versine::filter {

/// A named group of `Size` neighbouring error states. Blocks are the only place where an offset exists.
template <int Size>
struct Block {
  static constexpr int size = Size;
  int offset = -1;
  [[nodiscard]] constexpr bool enabled() const { return offset >= 0; }
};

/// The names of all states, in order; made by `Assembler` while it hands out the blocks.
class Assembler {
 public:
  /// The next `Size` states. `suffixes` (one character each, "xyz", "ned") name its rows; empty: the name alone.
  template <int Size>
  Block<Size> add(std::string_view name, std::string_view suffixes = "") {
    const Block<Size> block{static_cast<int>(names_.size())};
    for (int i = 0; i < Size; ++i) {
      std::string row(name);
      if (!suffixes.empty()) (row += '_') += suffixes[static_cast<std::size_t>(i)];
      names_.push_back(row);
    }
    return block;
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] int size() const { return static_cast<int>(names_.size()); }

 private:
  std::vector<std::string> names_;
};

}  // namespace versine::filter
