// SPDX-License-Identifier: Apache-2.0
#include "versine/report/texts.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace versine::report {

namespace {

using Map = std::map<std::string, std::string, std::less<>>;

Expected<Map> parse(std::string_view text, const std::string& name) {
  toml::table table;
  try {
    table = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    return fail({.file = name,
                 .line = error.source().begin.line,
                 .found = std::string(error.description()),
                 .expected = "TOML",
                 .advice = "compare with data/texts/en.toml"});
  }
  Map out;
  for (const auto& [section, content] : table) {
    const toml::table* keys = content.as_table();
    if (keys == nullptr) continue;
    for (const auto& [key, value] : *keys) {
      if (const auto s = value.value<std::string>())
        out[std::string(section.str()) + "." + std::string(key.str())] = *s;
    }
  }
  return out;
}

/// The places for numbers, "{}{:.2f}" of "{} of {:.2f}".
std::string places(const std::string& text) {
  std::string out;
  for (auto i = text.find('{'); i != std::string::npos; i = text.find('{', i + 1)) {
    out += text.substr(i, text.find('}', i) - i + 1);
  }
  return out;
}

/// The first key that only one of the two has; phrases are the translation's own business.
Expected<void> same_keys(const Map& ours, const Map& theirs, const std::string& name) {
  for (const auto& [key, text] : ours) {
    if (!theirs.contains(key)) {
      return fail({.file = name, .field = key, .found = "no such text", .expected = text, .advice = "translate it"});
    }
  }
  for (const auto& [key, text] : theirs) {
    if (!ours.contains(key)) {
      return fail({.file = name,
                   .field = key,
                   .found = "a text that no report uses",
                   .expected = "the keys of data/texts/en.toml",
                   .advice = "remove it or mend its name"});
    }
    if (places(text) != places(ours.at(key))) {
      return fail({.file = name,
                   .field = key,
                   .found = "'" + text + "'",
                   .expected = "the places " + places(ours.at(key)) + ", in this order",
                   .advice = "as in '" + ours.at(key) + "'"});
    }
  }
  return {};
}

/// What stands at the places of a pattern: "{} ends" fits "3 ends" with "3". Nothing when it does not fit.
std::optional<std::vector<std::string>> values_in(std::string_view text, std::string_view pattern) {
  std::vector<std::string> out;
  std::size_t place = pattern.find("{}");
  if (!text.starts_with(pattern.substr(0, place))) return std::nullopt;
  text.remove_prefix(std::min(place, text.size()));
  while (place != std::string_view::npos) {
    pattern.remove_prefix(place + 2);
    place = pattern.find("{}");
    const std::string_view behind = pattern.substr(0, place);
    const bool last = place == std::string_view::npos;
    if (last && !text.ends_with(behind)) return std::nullopt;
    const std::size_t end = last ? text.size() - behind.size() : text.find(behind);
    if (end == std::string_view::npos) return std::nullopt;
    out.emplace_back(text.substr(0, end));
    text.remove_prefix(end + behind.size());
  }
  return text.empty() ? std::optional(out) : std::nullopt;
}

}  // namespace

const std::vector<std::string>& languages() {
  static const std::vector<std::string> all{"en", "de", "zh"};
  return all;
}

Texts::Texts() : texts_(parse(built_in_texts("en"), "en.toml").value()) {}

Expected<Texts> Texts::load(const std::string& language) {
  Texts out;
  if (language == "en") return out;
  const std::string_view built_in = built_in_texts(language);
  std::string content(built_in), name = language + ".toml";
  if (built_in.empty()) {
    std::ifstream file(language, std::ios::binary);
    if (!file) {
      return fail({.field = "report.language",
                   .found = "'" + language + "'",
                   .expected = "en, de, zh, or the path of a file of texts",
                   .advice = "a translation is a copy of data/texts/en.toml"});
    }
    std::ostringstream bytes;
    bytes << file.rdbuf();
    content = bytes.str();
    name = language;
  }
  auto texts = parse(content, name);
  if (!texts) return tl::unexpected(texts.error());
  if (auto done = same_keys(out.texts_, *texts, name); !done) return tl::unexpected(done.error());
  out.texts_ = std::move(*texts);
  const auto tag = out.texts_.find("language.tag");
  out.language_ = tag == out.texts_.end() ? language : tag->second;
  return out;
}

const std::string& Texts::operator()(std::string_view key) const {
  const auto it = texts_.find(key);
  if (it == texts_.end()) throw std::out_of_range("Texts: no text '" + std::string(key) + "'");
  return it->second;
}

std::string Texts::phrase(const std::string& english) const {
  const auto exact = [&](const std::string& text) {
    const auto it = texts_.find("phrase." + text);
    return it == texts_.end() ? text : it->second;
  };
  if (texts_.contains("phrase." + english)) return exact(english);
  for (auto it = texts_.lower_bound("phrase."); it != texts_.end() && it->first.starts_with("phrase."); ++it) {
    const std::string_view pattern = std::string_view(it->first).substr(7);
    if (pattern.find("{}") == std::string_view::npos) continue;
    const auto values = values_in(english, pattern);
    if (!values) continue;
    std::string out = it->second;
    std::size_t at = 0;
    for (const std::string& value : *values) {
      at = out.find("{}", at);
      const std::string word = exact(value);
      out.replace(at, 2, word);
      at += word.size();
    }
    return out;
  }
  return english;
}

std::string Texts::quantity(const std::string& column) const {
  if (const auto it = texts_.find("quantity." + column); it != texts_.end()) return it->second;
  // "quantity.alignment_left_*" = "Alignment left {}": the longest pattern that fits.
  const std::string* best = nullptr;
  std::string rest;
  std::size_t longest = 0;
  for (const auto& [key, text] : texts_) {
    if (!key.starts_with("quantity.") || !key.ends_with("*")) continue;
    const std::string head = key.substr(9, key.size() - 10);
    if (!column.starts_with(head) || head.size() < longest) continue;
    longest = head.size();
    best = &text;
    rest = column.substr(head.size());
  }
  if (best == nullptr) return column;
  std::string out = *best;
  if (rest.size() == 2 && rest[0] == 'd') rest[0] = 'D';  // the bands of EN 13848
  std::replace(rest.begin(), rest.end(), '_', ' ');
  if (const auto at = out.find("{}"); at != std::string::npos) out.replace(at, 2, rest);
  return out;
}

}  // namespace versine::report
