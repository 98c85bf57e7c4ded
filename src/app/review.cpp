// SPDX-License-Identifier: Apache-2.0
#include "review.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace versine::app {

using json = nlohmann::ordered_json;

namespace {

Error wrong(std::size_t index, const char* key, const char* expected) {
  return {.field = fmt::format("constraint[{}].{}", index, key),
          .found = "a value that is not understood",
          .expected = expected};
}

Expected<toml::table> to_toml(const json& c, std::size_t index) {
  if (!c.is_object()) return tl::unexpected(wrong(index, "", "an object"));
  toml::table out;
  if (const auto name = c.find("recording"); name != c.end()) {
    if (!name->is_string()) return tl::unexpected(wrong(index, "recording", "a name"));
    out.insert("recording", name->get<std::string>());
  }
  for (const char* key : {"from_s", "to_s"}) {
    const auto value = c.find(key);
    if (value == c.end() || !value->is_number() || !std::isfinite(value->get<double>())) {
      return tl::unexpected(wrong(index, key, "seconds of the recording's clock"));
    }
    out.insert(key, value->get<double>());
  }
  if (!(c["from_s"].get<double>() <= c["to_s"].get<double>())) {
    return tl::unexpected(wrong(index, "to_s", "a time that is not before from_s"));
  }
  const auto tracks = c.find("tracks");
  if (tracks == c.end() || !tracks->is_array() || tracks->empty()) {
    return tl::unexpected(wrong(index, "tracks", "the identifiers of at least one track"));
  }
  toml::array ids;
  for (const json& id : *tracks) {
    if (!id.is_string()) return tl::unexpected(wrong(index, "tracks", "identifiers of tracks"));
    ids.push_back(id.get<std::string>());
  }
  out.insert("tracks", std::move(ids));
  if (const auto excluded = c.find("excluded"); excluded != c.end()) {
    if (!excluded->is_boolean()) return tl::unexpected(wrong(index, "excluded", "true or false"));
    out.insert("excluded", excluded->get<bool>());
  }
  if (const auto comment = c.find("comment"); comment != c.end() && comment->is_string()) {
    out.insert("comment", comment->get<std::string>());
  }
  return out;
}

}  // namespace

Expected<void> write_constraints(const std::filesystem::path& path, const std::string& text) {
  const json list = json::parse(text, nullptr, false);
  if (!list.is_array()) return fail({.found = "a review that is no JSON array"});
  toml::array tables;
  for (std::size_t i = 0; i < list.size(); ++i) {
    auto table = to_toml(list[i], i);
    if (!table) return tl::unexpected(table.error());
    tables.push_back(std::move(*table));
  }
  toml::table root;
  root.insert("constraint", std::move(tables));
  const auto part = std::filesystem::path(path).concat(".part");
  std::error_code code;
  {
    std::ofstream file(part, std::ios::binary);
    file << "# What a person decided in versine view. In the job: constraints = \"" << path.filename().string()
         << "\"\n\n"
         << root << '\n';
    if (!file.flush()) code = std::make_error_code(std::errc::io_error);
  }
  if (!code) std::filesystem::rename(part, path, code);
  if (!code) return {};
  return fail({.file = path.string(),
               .found = "that it cannot be written",
               .expected = "a folder that may be written to, beside the result",
               .advice = "copy the result to a place of your own and open it there"});
}

Expected<std::string> read_constraints(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return std::string("[]");
  toml::table root;
  try {
    root = toml::parse_file(path.string());
  } catch (const toml::parse_error& problem) {
    return fail({.file = path.string(),
                 .line = problem.source().begin.line,
                 .found = std::string(problem.description()),
                 .expected = "constraints as docs/formats-georef.md describes them",
                 .advice = "mend the line, or move the file away and review anew"});
  }
  const auto* list = root["constraint"].as_array();
  if (list == nullptr) return std::string("[]");
  std::ostringstream out;
  out << toml::json_formatter(*list);
  return out.str();
}

}  // namespace versine::app
