// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "versine/app/config.hpp"
#include "versine/core/text.hpp"

namespace versine::app {

namespace {

/// What all tables of one file share.
struct FileContext {
  std::filesystem::path path;
  std::vector<Error> errors;
};

InputPath resolve(const std::string& written, const FileContext& file) {
  std::string text = written;
  const std::string_view variable = "${VERSINE_DATA}";
  if (const auto at = text.find(variable); at != std::string::npos) {
    const char* folder = std::getenv("VERSINE_DATA");
    text.replace(at, variable.size(), folder == nullptr ? "VERSINE_DATA-is-not-set" : folder);
  }
  std::filesystem::path path = text;
  if (path.is_relative()) path = file.path.parent_path() / path;
  return {path.lexically_normal(), written};
}

class TomlReader final : public ConfigVisitor {
 public:
  TomlReader(const toml::table* table, std::string prefix, FileContext& file)
      : table_(table), prefix_(std::move(prefix)), file_(file) {}

  void value(std::string_view key, double& v, const KeySpec& spec) override {
    if (const auto* node = find(key, spec)) number(key, *node, spec, v);
  }
  void value(std::string_view key, std::optional<double>& v, const KeySpec& spec) override {
    double x = 0.0;
    if (const auto* node = find(key, spec); node != nullptr && number(key, *node, spec, x)) v = x;
  }
  void value(std::string_view key, int& v, const KeySpec& spec) override {
    const auto* node = find(key, spec);
    if (node == nullptr) return;
    if (!node->is_integer()) return wrong(key, *node, "a whole number");
    const auto n = node->as_integer()->get();
    if (!in_range(static_cast<double>(n), spec) || n > std::numeric_limits<int>::max()) {
      return out_of_range(key, *node, spec);
    }
    v = static_cast<int>(n);
  }
  void value(std::string_view key, bool& v, const KeySpec& spec) override {
    const auto* node = find(key, spec);
    if (node == nullptr) return;
    if (!node->is_boolean()) return wrong(key, *node, "true or false");
    v = node->as_boolean()->get();
  }
  void value(std::string_view key, std::string& v, const KeySpec& spec) override {
    const auto* node = find(key, spec);
    if (node == nullptr) return;
    if (!node->is_string()) return wrong(key, *node, "text in quotes");
    v = node->as_string()->get();
  }
  void value(std::string_view key, InputPath& v, const KeySpec& spec) override {
    std::string text;
    value(key, text, spec);
    if (!text.empty()) v = resolve(text, file_);
  }
  void value(std::string_view key, std::vector<double>& v, const KeySpec& spec) override {
    if (const auto* node = find(key, spec)) numbers(key, *node, spec, v);
  }
  void value(std::string_view key, Eigen::Vector3d& v, const KeySpec& spec) override {
    const auto* node = find(key, spec);
    if (node == nullptr) return;
    std::vector<double> list;
    if (!numbers(key, *node, spec, list)) return;
    if (list.size() != 3) return wrong(key, *node, "three numbers in brackets");
    v = {list[0], list[1], list[2]};
  }
  void value(std::string_view key, std::optional<Eigen::Vector3d>& v, const KeySpec& spec) override {
    Eigen::Vector3d x = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    value(key, x, spec);
    if (x.allFinite()) v = x;
  }
  void value(std::string_view key, std::vector<std::string>& v, const KeySpec& spec) override {
    const auto* node = find(key, spec);
    if (node == nullptr) return;
    const auto* array = node->as_array();
    if (array == nullptr) return wrong(key, *node, "a list of texts");
    v.clear();
    for (const auto& item : *array) {
      if (!item.is_string()) return wrong(key, item, "text in quotes");
      v.push_back(item.as_string()->get());
    }
  }
  void value(std::string_view key, std::vector<InputPath>& v, const KeySpec& spec) override {
    std::vector<std::string> texts;
    value(key, texts, spec);
    if (!texts.empty()) v.clear();
    for (const auto& text : texts) v.push_back(resolve(text, file_));
  }
  void value(std::string_view key, std::map<std::string, std::string>& v, const KeySpec& spec) override {
    const auto* node = find(key, spec);
    if (node == nullptr) return;
    const auto* table = node->as_table();
    if (table == nullptr) return wrong(key, *node, "a table of texts");
    for (const auto& [name, item] : *table) {
      if (!item.is_string()) return wrong(key, item, "text in quotes");
      v[std::string(name.str())] = item.as_string()->get();
    }
  }

  void table(std::string_view key, std::string_view, const std::function<void(ConfigVisitor&)>& body,
             bool* present) override {
    const auto* node = find(key, {});
    if (present != nullptr) *present = node != nullptr;
    if (node != nullptr && !node->is_table()) return wrong(key, *node, "a table");
    TomlReader reader(node == nullptr ? nullptr : node->as_table(), prefix_ + std::string(key) + ".", file_);
    reader.optional_ = node == nullptr;
    body(reader);
    reader.report_unknown();
  }

  void report_unknown() {
    if (table_ == nullptr) return;
    const std::vector<std::string_view> known(known_.begin(), known_.end());
    for (const auto& [key, node] : *table_) {
      if (known_.contains(std::string(key.str()))) continue;
      const std::string_view near = nearest(key.str(), known);
      Error error = at(key.str(), node);
      error.found = "an unknown key";
      error.advice = near.empty() ? fmt::format("known keys here: {}", fmt::join(known, ", "))
                                  : fmt::format("did you mean '{}'?", near);
      file_.errors.push_back(std::move(error));
    }
  }

 protected:
  void choose(std::string_view key, std::size_t& index, std::span<const std::string_view> words,
              const KeySpec& spec) override {
    const auto* node = find(key, spec);
    if (node == nullptr) return;
    const auto* text = node->as_string();
    if (text == nullptr) return wrong(key, *node, fmt::format("one of '{}'", fmt::join(words, "', '")));
    const auto it = std::find(words.begin(), words.end(), text->get());
    if (it == words.end()) {
      const std::string_view near = nearest(text->get(), words);
      Error error = at(key, *node);
      error.found = fmt::format("'{}'", text->get());
      error.expected = fmt::format("one of '{}'", fmt::join(words, "', '"));
      if (!near.empty()) error.advice = fmt::format("did you mean '{}'?", near);
      file_.errors.push_back(std::move(error));
      return;
    }
    index = static_cast<std::size_t>(it - words.begin());
  }
  std::size_t count(std::string_view key, std::size_t have) override {
    const auto* node = find(key, {});
    if (node == nullptr) return have;
    const auto* array = node->as_array();
    if (array == nullptr || (!array->empty() && !array->is_array_of_tables())) {
      wrong(key, *node, fmt::format("a list of tables, written [[{}{}]]", prefix_, key));
      return 0;
    }
    return array->size();
  }
  void items(std::string_view key, std::string_view, std::size_t count,
             const std::function<void(ConfigVisitor&, std::size_t)>& body) override {
    const auto* node = find(key, {});
    if (node == nullptr || node->as_array() == nullptr) return;
    for (std::size_t i = 0; i < count; ++i) {
      TomlReader reader(node->as_array()->get(i)->as_table(), fmt::format("{}{}[{}].", prefix_, key, i), file_);
      body(reader, i);
      reader.report_unknown();
    }
  }

 private:
  const toml::node* find(std::string_view key, const KeySpec& spec) {
    known_.insert(std::string(key));
    const toml::node* node = table_ == nullptr ? nullptr : table_->get(key);
    if (node == nullptr && spec.required && !optional_) {
      Error error{.file = file_.path.string(), .field = prefix_ + std::string(key)};
      error.found = "nothing";
      error.expected = std::string(spec.doc);
      error.advice = spec.example.empty() ? "add the key" : fmt::format("add '{} = {}'", key, spec.example);
      file_.errors.push_back(std::move(error));
    }
    return node;
  }
  Error at(std::string_view key, const toml::node& node) const {
    Error error{.file = file_.path.string(), .line = node.source().begin.line, .field = prefix_ + std::string(key)};
    return error;
  }
  void wrong(std::string_view key, const toml::node& node, std::string expected) {
    Error error = at(key, node);
    std::ostringstream text;
    text << toml::node_view<const toml::node>(node);
    error.found = text.str();
    error.expected = std::move(expected);
    file_.errors.push_back(std::move(error));
  }
  static bool in_range(double x, const KeySpec& spec) {
    return x >= spec.min && x <= spec.max && (!spec.positive || x > 0.0);
  }
  void out_of_range(std::string_view key, const toml::node& node, const KeySpec& spec) {
    std::string range = spec.positive && !(spec.min > 0.0) ? "more than 0" : "";
    if (std::isfinite(spec.min) && !(spec.positive && spec.min <= 0.0)) range = fmt::format("at least {}", spec.min);
    if (std::isfinite(spec.max)) range += fmt::format("{}at most {}", range.empty() ? "" : " and ", spec.max);
    wrong(key, node,
          fmt::format("{}{}{}", range.empty() ? "a finite number" : range, spec.unit.empty() ? "" : " ", spec.unit));
  }
  bool number(std::string_view key, const toml::node& node, const KeySpec& spec, double& v) {
    const auto x = node.is_number() ? node.value<double>() : std::nullopt;
    if (!x) {
      wrong(key, node, spec.unit.empty() ? "a number" : fmt::format("a number in {}", spec.unit));
      return false;
    }
    if (!std::isfinite(*x) || !in_range(*x, spec)) {
      out_of_range(key, node, spec);
      return false;
    }
    v = *x * spec.scale;
    return true;
  }
  bool numbers(std::string_view key, const toml::node& node, const KeySpec& spec, std::vector<double>& v) {
    const auto* array = node.as_array();
    if (array == nullptr) {
      wrong(key, node, "a list of numbers in brackets");
      return false;
    }
    std::vector<double> list;
    for (const auto& item : *array) {
      double x = 0.0;
      if (!number(key, item, spec, x)) return false;
      list.push_back(x);
    }
    v = std::move(list);
    return true;
  }

  const toml::table* table_;
  std::string prefix_;
  FileContext& file_;
  std::set<std::string> known_;
  bool optional_ = false;  ///< the table itself is absent: its required keys are not missed
};

Error first_of(std::vector<Error> errors) {
  Error first = std::move(errors.front());
  for (std::size_t i = 1; i < errors.size(); ++i) {
    first.advice += (first.advice.empty() ? "" : "\n") + errors[i].message();
  }
  return first;
}

/// Puts `a.b.c = value` into the table, making the tables on the way.
Expected<void> apply_override(toml::table& root, const std::string& text) {
  const auto refuse = [&](std::string why) {
    return fail({.field = "--set " + text,
                 .found = std::move(why),
                 .expected = "key=value, the value as TOML writes it",
                 .advice = "for example --set output.rate_hz=10 or --set imu.axes='\"right-forward-up\"'"});
  };
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0) return refuse("no '='");
  toml::table parsed;
  try {
    parsed = toml::parse(text, std::string_view("--set"));
  } catch (const toml::parse_error&) {
    try {  // a bare word is taken as text
      parsed = toml::parse(fmt::format("{} = \"{}\"", text.substr(0, equals), text.substr(equals + 1)),
                           std::string_view("--set"));
    } catch (const toml::parse_error& error) {
      return refuse(std::string(error.description()));
    }
  }
  const std::function<void(toml::table&, toml::table&)> merge = [&](toml::table& into, toml::table& from) {
    for (auto& [key, node] : from) {
      toml::node* have = into.get(key.str());
      if (have != nullptr && have->is_table() && node.is_table()) {
        merge(*have->as_table(), *node.as_table());
      } else {
        into.insert_or_assign(key.str(), node);
      }
    }
  };
  merge(root, parsed);
  return {};
}

}  // namespace

Expected<void> parse_config(std::string_view text, const std::filesystem::path& path, const Description& description,
                            std::span<const std::string> overrides) {
  toml::table root;
  try {
    root = toml::parse(text, std::string_view(path.native()));
  } catch (const toml::parse_error& error) {
    return fail({.file = path.string(),
                 .line = error.source().begin.line,
                 .found = std::string(error.description()),
                 .expected = "a TOML file",
                 .advice = "see docs/ for the job's keys, or 'versine init' for a template"});
  }
  for (const auto& text_override : overrides) {
    if (auto done = apply_override(root, text_override); !done) return done;
  }
  FileContext file{std::filesystem::absolute(path), {}};
  const auto shown = path;
  TomlReader reader(&root, "", file);
  description(reader);
  reader.report_unknown();
  if (file.errors.empty()) return {};
  for (auto& error : file.errors) error.file = shown.string();
  return tl::unexpected(first_of(std::move(file.errors)));
}

Expected<void> read_config(const std::filesystem::path& path, const Description& description,
                           std::span<const std::string> overrides) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  if (!std::filesystem::is_regular_file(path) || !(text << stream.rdbuf())) {
    return fail({.file = path.string(),
                 .found = "no file that can be read",
                 .expected = "a job file in TOML",
                 .advice = "'versine init survey > job.toml' writes a commented template"});
  }
  return parse_config(text.str(), path, description, overrides);
}

}  // namespace versine::app
