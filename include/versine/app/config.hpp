// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "versine/core/error.hpp"

/// One declaration of a configuration, four uses: reading a TOML file, its documentation, a commented template, and
/// the effective settings written into run.json. A configuration is a plain struct with a free function
/// `void describe(ConfigVisitor&, T&)` that names each key once, with unit, range and meaning; the value that the
/// struct has by default is the default of the key.
namespace versine::app {

/// What a key is, besides its name and place.
struct KeySpec {
  std::string_view doc;        ///< one sentence: what it means, what it changes
  std::string_view unit = "";  ///< of the number as the user writes it; the key's name ends in it too
  double scale = 1.0;          ///< value inside = value written * scale (units.hpp)
  double min = -std::numeric_limits<double>::infinity();  ///< as written, inclusive
  double max = std::numeric_limits<double>::infinity();
  bool positive = false;  ///< zero is refused too
  bool required = false;
  std::string_view example = "";  ///< shown in a template when there is no default worth showing
};

/// A file named in a job: absolute, with `${VERSINE_DATA}` expanded and relative paths taken from the job's folder.
/// `written` keeps what the user wrote, for messages and for run.json.
struct InputPath {
  std::filesystem::path path;
  std::string written;
  [[nodiscard]] bool empty() const { return written.empty(); }
};

class ConfigVisitor {
 public:
  virtual ~ConfigVisitor() = default;

  virtual void value(std::string_view key, double& v, const KeySpec& spec) = 0;
  virtual void value(std::string_view key, int& v, const KeySpec& spec) = 0;
  virtual void value(std::string_view key, bool& v, const KeySpec& spec) = 0;
  virtual void value(std::string_view key, std::string& v, const KeySpec& spec) = 0;
  virtual void value(std::string_view key, InputPath& v, const KeySpec& spec) = 0;
  virtual void value(std::string_view key, std::optional<double>& v, const KeySpec& spec) = 0;
  virtual void value(std::string_view key, std::vector<double>& v, const KeySpec& spec) = 0;
  virtual void value(std::string_view key, std::vector<std::string>& v, const KeySpec& spec) = 0;
  virtual void value(std::string_view key, std::vector<InputPath>& v, const KeySpec& spec) = 0;
  virtual void value(std::string_view key, Eigen::Vector3d& v, const KeySpec& spec) = 0;
  virtual void value(std::string_view key, std::optional<Eigen::Vector3d>& v, const KeySpec& spec) = 0;
  /// A free table of text to text, such as `[columns]`.
  virtual void value(std::string_view key, std::map<std::string, std::string>& v, const KeySpec& spec) = 0;

  /// One of a list of words; `names` pairs each word with the enumerator it stands for.
  template <class Enum>
  void choice(std::string_view key, Enum& v, std::span<const std::pair<std::string_view, Enum>> names,
              const KeySpec& spec) {
    std::vector<std::string_view> words;
    std::size_t index = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
      words.push_back(names[i].first);
      if (names[i].second == v) index = i;
    }
    choose(key, index, words, spec);
    v = names[index].second;
  }

  /// A sub-table. `present`: the table switches something on; a reader tells there whether the file has it, others
  /// leave it, and a template shows the table commented out.
  virtual void table(std::string_view key, std::string_view doc, const std::function<void(ConfigVisitor&)>& body,
                     bool* present = nullptr) = 0;

  /// `[[key]]`: a list of tables.
  template <class T>
  void tables(std::string_view key, std::string_view doc, std::vector<T>& list,
              const std::function<void(ConfigVisitor&, T&)>& body) {
    list.resize(count(key, list.size()));
    T sample{};  // what a documentation or template visitor looks at
    items(key, doc, list.size(), [&](ConfigVisitor& v, std::size_t i) { body(v, i < list.size() ? list[i] : sample); });
  }

 protected:
  virtual void choose(std::string_view key, std::size_t& index, std::span<const std::string_view> words,
                      const KeySpec& spec) = 0;
  /// How many `[[key]]` tables there are; a reader asks its file, others return `have`.
  virtual std::size_t count(std::string_view key, std::size_t have) = 0;
  /// Visits each item; documentation and template visitors call `body` once, with an index that no item has.
  virtual void items(std::string_view key, std::string_view doc, std::size_t count,
                     const std::function<void(ConfigVisitor&, std::size_t)>& body) = 0;
};

using Description = std::function<void(ConfigVisitor&)>;

/// Reads the TOML file at `path` into what `description` describes. `overrides` are `key.sub=value` from the command
/// line (`--set`), in TOML's syntax for values. All faults of the file are found in one go; the first is the Error's
/// own, the others follow in its advice. Unknown keys are errors that name the nearest key.
[[nodiscard]] Expected<void> read_config(const std::filesystem::path& path, const Description& description,
                                         std::span<const std::string> overrides = {});
/// The same from text; `path` serves messages and relative paths.
[[nodiscard]] Expected<void> parse_config(std::string_view text, const std::filesystem::path& path,
                                          const Description& description, std::span<const std::string> overrides = {});

/// Markdown: a section per table, a row per key (key, type and unit, default, range, meaning).
[[nodiscard]] std::string config_documentation(const Description& description);
/// TOML with every key, its default commented out, its meaning above it.
[[nodiscard]] std::string config_template(const Description& description);
/// TOML with every line commented out.
[[nodiscard]] std::string commented_out(const std::string& text);
/// The effective values as a JSON object, as text.
[[nodiscard]] std::string config_json(const Description& description);

}  // namespace versine::app
