// SPDX-License-Identifier: Apache-2.0
#include "review.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "versine/app/constraints.hpp"

namespace versine::app {

using json = nlohmann::ordered_json;

namespace {

/// Only the notation changes; what a constraint must have is for read_constraints to say.
template <class Container>
void insert(Container& into, const json& value, const auto&... key) {
  const auto add = [&](auto&& node) {
    if constexpr (sizeof...(key) == 0) {
      into.push_back(std::forward<decltype(node)>(node));
    } else {
      into.insert(key..., std::forward<decltype(node)>(node));
    }
  };
  if (value.is_string()) return add(value.get<std::string>());
  if (value.is_boolean()) return add(value.get<bool>());
  if (value.is_number_integer()) return add(value.get<std::int64_t>());
  if (value.is_number()) return add(value.get<double>());
  if (value.is_array()) {
    toml::array list;
    for (const json& item : value) insert(list, item);
    return add(std::move(list));
  }
  if (value.is_object()) {
    toml::table table;
    for (const auto& [name, item] : value.items()) insert(table, item, name);
    return add(std::move(table));
  }
}

Error not_written(const std::filesystem::path& path) {
  return {.file = path.string(),
          .found = "that it cannot be written",
          .expected = "a folder that may be written to, beside the result",
          .advice = "copy the result to a place of your own and open it there"};
}

}  // namespace

Expected<void> save_review(const std::filesystem::path& path, const std::string& text) {
  const json list = json::parse(text, nullptr, false);
  if (!list.is_array()) return fail({.found = "a review that is no JSON array"});
  if (const auto before = load_review(path); !before) return tl::unexpected(before.error());
  toml::table root;
  insert(root, list, "constraint");
  const auto part = std::filesystem::path(path).concat(".part");
  {
    std::ofstream file(part, std::ios::binary);
    file << "# What a person decided in versine view. In the job: constraints = \"" << path.filename().string()
         << "\"\n\n"
         << root << '\n';
    if (!file.flush()) return tl::unexpected(not_written(path));
  }
  std::error_code code;
  if (const auto understood = read_constraints(part); !understood) {
    std::filesystem::remove(part, code);
    Error error = understood.error();
    error.file.clear(), error.line = 0;  // of a file that nobody has seen
    return tl::unexpected(error);
  }
  std::filesystem::rename(part, path, code);
  if (code) return tl::unexpected(not_written(path));
  return {};
}

Expected<std::string> load_review(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return std::string("[]");
  auto constraints = read_constraints(path);
  if (!constraints) return tl::unexpected(constraints.error());
  return json::parse(config_json([&](ConfigVisitor& v) { describe(v, *constraints); }))["constraint"].dump();
}

}  // namespace versine::app
