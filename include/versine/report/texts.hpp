// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "versine/core/error.hpp"

namespace versine::report {

/// Every word of the reports in one language: data/texts/<language>.toml, built into the program. A translation is a
/// file with the same keys.
class Texts {
 public:
  /// "en", "de", "zh", or the path of a TOML file with the same keys. Fails on an unknown language, a file that cannot
  /// be read, and a missing or unknown key, naming it.
  [[nodiscard]] static Expected<Texts> load(const std::string& language);
  /// English.
  Texts();

  /// "cover.title" and so on. REQUIRES that the key exists.
  [[nodiscard]] const std::string& operator()(std::string_view key) const;
  /// A sentence that comes from a result file (a convention, a unit, a warning), translated; itself when it has none. In
  /// the file a sentence with values has {} at their places, in the same order in each language.
  [[nodiscard]] std::string phrase(const std::string& english) const;
  /// Name of a column of track geometry for a person: "alignment_left_d1" is "Alignment left D1".
  [[nodiscard]] std::string quantity(const std::string& column) const;

  [[nodiscard]] const std::string& language() const { return language_; }
  [[nodiscard]] const std::map<std::string, std::string, std::less<>>& all() const { return texts_; }

 private:
  std::string language_ = "en";
  std::map<std::string, std::string, std::less<>> texts_;
};

/// The languages that are built in.
[[nodiscard]] const std::vector<std::string>& languages();
/// Content of a built-in file; made by CMake from data/texts/<language>.toml. Empty for an unknown language.
[[nodiscard]] std::string_view built_in_texts(std::string_view language);

}  // namespace versine::report
