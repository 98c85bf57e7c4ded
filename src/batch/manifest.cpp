// SPDX-License-Identifier: Apache-2.0
#include "versine/batch/manifest.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <sstream>

#include "versine/core/file_system.hpp"
#include "versine/io/sha256.hpp"

namespace versine::batch {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {
constexpr const char* manifest_format = "versine manifest 1";

std::string units_text(const Manifest& m) {
  std::string text;
  for (const Unit& u : m.units) {
    Json inputs = Json::array();
    for (const Input& i : u.inputs) inputs.push_back({{"uri", i.uri}, {"sha256", i.sha256}, {"bytes", i.bytes}});
    text += Json{{"unit", u.unit}, {"stage", u.stage}, {"inputs", inputs}, {"weight", u.weight}, {"shard", u.shard}}
                .dump() +
            "\n";
  }
  return text;
}

std::string head_text(const Manifest& m, const std::string& units) {
  return Json{{"format", manifest_format}, {"engine", m.engine},      {"stage", m.stage},
              {"config", m.job.config},    {"job_file", m.job.path},  {"job", m.job.text},
              {"shards", m.shards},        {"units", m.units.size()}, {"units_sha256", io::sha256(units)}}
             .dump(1) +
         "\n";
}

Failure changed(const fs::path& path, std::string found) {
  return {Exit::changed,
          {.file = path.string(),
           .found = std::move(found),
           .expected = "a manifest as 'versine batch plan' wrote it",
           .advice = "plan again; receipts of units that are the same stay valid"}};
}

Unit unit_from(const Json& j) {
  Unit u{j.at("unit"), j.at("stage"), {}, j.at("weight"), j.at("shard")};
  for (const auto& i : j.at("inputs")) u.inputs.push_back({i.at("uri"), i.at("sha256"), i.at("bytes")});
  return u;
}

Outcome<std::string> find_id(const Store& store, const std::string& id) {
  std::vector<std::string> found;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(store.manifests(), code)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(id)) found.push_back(name);
  }
  if (found.size() == 1) return found.front();
  return failure(Exit::usage, {.file = store.manifests().string(),
                               .field = "manifest",
                               .found = found.empty() ? "none" + (id.empty() ? "" : " that begins with '" + id + "'")
                                                      : std::to_string(found.size()) + " that it may be",
                               .expected = "one manifest",
                               .advice = "name it with --manifest or VERSINE_MANIFEST, as 'batch plan' printed it"});
}
}  // namespace

std::string unit_name(const std::string& engine, const std::string& config, const std::string& stage,
                      const std::vector<Input>& inputs) {
  std::string text = engine + "\n" + config + "\n" + stage + "\n";
  for (const Input& i : inputs) text += i.sha256 + "\n";
  return io::sha256(text);
}

Manifest make_manifest(std::string engine, std::string stage, Job job, const std::vector<std::vector<Input>>& inputs,
                       int shards) {
  Manifest m{{}, std::move(engine), std::move(stage), std::move(job), shards, {}};
  std::set<std::string> seen;
  for (const auto& together : inputs) {
    Unit u{unit_name(m.engine, m.job.config, m.stage, together), m.stage, together, 0, 0};
    for (const Input& i : together) u.weight += i.bytes;
    if (seen.insert(u.unit).second) m.units.push_back(std::move(u));
  }
  std::sort(m.units.begin(), m.units.end(),
            [](const Unit& a, const Unit& b) { return a.weight != b.weight ? a.weight > b.weight : a.unit < b.unit; });
  std::vector<std::uintmax_t> load(static_cast<std::size_t>(shards), 0);
  for (Unit& u : m.units) {
    const auto least = std::min_element(load.begin(), load.end());
    u.shard = static_cast<int>(least - load.begin());
    *least += u.weight + 1;  // empty files count too
  }
  std::sort(m.units.begin(), m.units.end(), [](const Unit& a, const Unit& b) { return a.unit < b.unit; });
  return m;
}

Outcome<void> write_manifest(const Store& store, Manifest& m) {
  const std::string units = units_text(m), head = head_text(m, units);
  m.id = io::sha256(head);
  const fs::path folder = store.manifests() / m.id;
  std::error_code code;
  if (fs::exists(folder / "manifest.json", code)) return {};
  fs::create_directories(folder, code);
  for (const auto& [name, text] : {std::pair("units.jsonl", &units), std::pair("manifest.json", &head)}) {
    const auto written = store.write_tmp(*text);
    if (!written) return tl::unexpected(written.error());
    fs::rename(*written, folder / name, code);
    if (code || !flush_one(folder)) {
      return failure(Exit::again, {.file = (folder / name).string(),
                                   .found = code.message(),
                                   .expected = "a store that can be written",
                                   .advice = "check its permissions and free space"});
    }
  }
  static_cast<void>(flush_one(store.manifests()));
  return {};
}

Outcome<Manifest> read_manifest(const Store& store, const std::string& id) {
  const auto name = find_id(store, id);
  if (!name) return tl::unexpected(name.error());
  const fs::path folder = store.manifests() / *name;
  const auto head = read_file(folder / "manifest.json"), units = read_file(folder / "units.jsonl");
  if (!head) return tl::unexpected(head.error());
  if (!units) return tl::unexpected(units.error());
  if (io::sha256(*head) != *name) return tl::unexpected(changed(folder / "manifest.json", "another content"));
  try {
    const Json j = Json::parse(*head);
    if (io::sha256(*units) != j.at("units_sha256").get<std::string>()) {
      return tl::unexpected(changed(folder / "units.jsonl", "another content"));
    }
    Manifest m{*name, j.at("engine"), j.at("stage"), {j.at("job_file"), j.at("job"), j.at("config")}, j.at("shards"),
               {}};
    std::istringstream lines(*units);
    for (std::string line; std::getline(lines, line);) m.units.push_back(unit_from(Json::parse(line)));
    return m;
  } catch (const nlohmann::json::exception& e) {
    return tl::unexpected(changed(folder / "manifest.json", e.what()));
  }
}

}  // namespace versine::batch
