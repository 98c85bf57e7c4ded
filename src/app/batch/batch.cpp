// SPDX-License-Identifier: Apache-2.0
#include "versine/app/batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "versine/app/version.hpp"
#include "versine/core/file_system.hpp"
#include "versine/io/run_json.hpp"
#include "versine/io/sha256.hpp"

namespace versine::app {

namespace fs = std::filesystem;
using batch::Exit;
using batch::failure;
using batch::Outcome;

namespace {
Expected<GeorefConfig> read_job(const std::string& text, const fs::path& path) {
  GeorefConfig config;
  const std::string no_recordings[] = {"recordings=[]"};  // the manifest names them
  const auto read = parse_config(
      text, path, [&](ConfigVisitor& v) { describe(v, config); }, no_recordings);
  if (!read) return tl::unexpected(read.error());
  if (auto more = load_constraints(config); !more) return tl::unexpected(more.error());
  return config;
}

/// Digest of all that a result depends on besides its inputs: the settings, without the places of files, and the map.
Expected<std::string> config_digest(const GeorefConfig& config) {
  const auto map = io::describe_input("network", config.network.written, config.network.path);
  if (!map) return tl::unexpected(map.error());
  std::string digests = map->sha256;
  for (const char* ending : {".dbf", ".shx", ".prj", ".cpg"}) {  // a Shapefile is several files
    fs::path part = config.network.path;
    if (part.extension() != ".shp" || !fs::exists(part.replace_extension(ending))) continue;
    const auto more = io::describe_input("network", part.string(), part);
    if (!more) return tl::unexpected(more.error());
    digests += more->sha256;
  }
  GeorefConfig c = config;
  c.network = {};
  c.constraints_file = {};  // what it says is among the constraints
  c.title.clear();
  c.recordings.clear();
  return io::sha256(config_json([&](ConfigVisitor& v) { describe(v, c); }) + "\n" + digests);
}

/// A recording's name or a reader's message without the path of the file: what a unit leaves must not tell where it
/// ran.
std::string without_path(std::string text, const std::string& path) {
  for (std::size_t at = text.find(path); at != std::string::npos; at = text.find(path)) {
    const bool colon = at + path.size() < text.size() && text[at + path.size()] == ':';
    text.erase(at, path.size() + (colon ? 1 : 0));
  }
  return text;
}

Error without_path(Error e, const std::string& path) {
  for (std::string* s : {&e.file, &e.field, &e.found, &e.expected, &e.advice}) *s = without_path(*s, path);
  return e;
}

/// A folder for a unit's monitoring results until they are in the store.
class Scratch {
 public:
  Scratch() {
    const char* given = std::getenv("VERSINE_SCRATCH");
    folder_ = (given != nullptr ? fs::path(given) : fs::temp_directory_path()) /
              fmt::format("versine-batch-{}", process_id());
    std::error_code code;
    fs::create_directories(folder_, code);
  }
  ~Scratch() {
    std::error_code code;
    fs::remove_all(folder_, code);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
};

Outcome<void> check_input(const batch::Input& input) {
  const auto now = io::describe_input("recording", input.uri, input.uri);
  if (!now) return failure(Exit::again, now.error());
  if (now->sha256 == input.sha256) return {};
  return failure(Exit::changed, {.file = input.uri,
                                 .found = fmt::format("{} bytes with another SHA-256", now->bytes),
                                 .expected = fmt::format("the {} bytes that were planned", input.bytes),
                                 .advice = "plan again; receipts of the other units stay valid"});
}
}  // namespace

std::string batch_engine() {
  return "versine " + version() + " georef 1";
}

Outcome<batch::Job> batch_job(const fs::path& job) {
  auto text = batch::read_file(job);
  if (!text) return failure(Exit::usage, text.error().error);
  const auto path = fs::absolute(job);
  const auto config = read_job(*text, path);
  if (!config) return failure(Exit::usage, config.error());
  // A unit is its inputs' content: what names single recordings cannot be part of all units.
  const bool named = std::any_of(config->constraints.begin(), config->constraints.end(),
                                 [](const georef::Constraint& c) { return !c.recording.empty(); });
  for (const auto& [key, present] :
       {std::pair("monitoring", !config->monitoring.empty()), std::pair("constraint.recording", named),
        std::pair("recording", !config->tables.empty())}) {
    if (!present) continue;
    return failure(Exit::usage,
                   {.file = job.string(),
                    .field = key,
                    .found = "what belongs to single recordings",
                    .expected = "a job for all of them",
                    .advice = "put [[constraint]] and [[monitoring]] into a file beside the recording that "
                              "has its name and .toml"});
  }
  const auto map = load_map(*config);
  if (!map) return failure(Exit::usage, map.error());
  if (auto good = georef::check(**map, config->constraints); !good) return failure(Exit::usage, good.error());
  const auto digest = config_digest(*config);
  if (!digest) return failure(Exit::again, digest.error());
  return batch::Job{path.string(), std::move(*text), *digest};
}

Outcome<GeorefStage> GeorefStage::prepare(const batch::Manifest& m) {
  const auto other = [&](std::string field, std::string found, std::string expected) {
    return failure(Exit::configuration, {.file = m.job.path,
                                         .field = std::move(field),
                                         .found = std::move(found),
                                         .expected = std::move(expected),
                                         .advice = "use the program and the map of the manifest, or plan again"});
  };
  if (m.engine != batch_engine()) return other("engine", m.engine, batch_engine());
  const auto config = read_job(m.job.text, m.job.path);
  if (!config) return failure(Exit::configuration, config.error());
  const auto digest = config_digest(*config);
  if (!digest) return failure(Exit::configuration, digest.error());
  if (*digest != m.job.config) return other("config", *digest, m.job.config);
  auto map = load_map(*config);
  if (!map) return failure(Exit::configuration, map.error());
  GeorefStage stage;
  stage.config_ = *config;
  stage.map_ = std::move(*map);
  return stage;
}

Outcome<batch::Made> GeorefStage::operator()(const batch::Unit& unit) const {
  for (const auto& i : unit.inputs) {
    if (const auto same = check_input(i); !same) return tl::unexpected(same.error());
  }
  const batch::Input& input = unit.inputs.front();
  // The bytes are those of the manifest: what a reader cannot make sense of is bad data, wherever it is tried.
  batch::Made made;
  const auto reject = [&](const Error& e) {
    made.rejection = without_path(e, input.uri);
    return made;
  };
  GeorefCompanion companion;
  if (unit.inputs.size() > 1) {
    auto read = read_companion(unit.inputs[1].uri);
    if (!read) return reject(read.error());
    if (auto good = georef::check(*map_, read->constraints); !good) return reject(good.error());
    companion = std::move(*read);
  }
  std::vector<Error> faults;
  auto recordings = load_recordings(input.uri, faults);
  if (!recordings) return reject(recordings.error());
  batch::Summary summary;
  for (const auto& f : faults) {
    const Error e = without_path(f, input.uri);
    summary.failures.push_back({e.file, e});
  }
  companion.constraints.insert(companion.constraints.end(), config_.constraints.begin(), config_.constraints.end());
  std::vector<GeorefOutcome> outcomes;
  std::vector<const georef::RecordingResult*> results;
  for (auto& r : *recordings) {
    r.name = without_path(r.name, input.uri);
    std::string name = r.name;
    outcomes.push_back(
        {std::move(name), georef::georeference(*map_, std::move(r), config_.options, companion.constraints)});
  }
  for (const auto& o : outcomes) {
    if (!o.result) {
      summary.failures.push_back({o.name, without_path(o.result.error(), input.uri)});
      continue;
    }
    for (auto& j : journey_entries(*map_, *o.result)) summary.journeys.push_back(std::move(j));
    results.push_back(&*o.result);
  }
  if (results.empty()) {
    made.rejection = summary.failures.empty() ? Error{.field = "recordings", .found = "none"}
                                              : std::move(summary.failures.front().error);
    return made;
  }
  made.files.push_back({"positions", positions_table(*map_, results, config_.csv_interval)});
  if (auto done = stamp(companion, outcomes, summary, made); !done) return tl::unexpected(done.error());
  made.files.insert(made.files.begin(), {"summary", batch::to_text(summary)});
  return made;
}

Outcome<void> GeorefStage::stamp(const GeorefCompanion& companion, const std::vector<GeorefOutcome>& outcomes,
                                 batch::Summary& summary, batch::Made& made) const {
  if (companion.monitoring.empty()) return {};
  const Scratch scratch;
  SilentProgress silent;
  for (std::size_t i = 0; i < companion.monitoring.size(); ++i) {
    const auto& m = companion.monitoring[i];
    const auto done = stamp_monitoring(scratch.folder(), *map_, outcomes, {m}, silent);
    if (!done && done.error().file.starts_with(scratch.folder().string())) return failure(Exit::again, done.error());
    if (!done) {
      // As the companion names the file, not where it was: the same bytes wherever it ran.
      Error e = without_path(done.error(), m.file.path.string());
      e.file = m.file.written;
      summary.failures.push_back({m.file.written, std::move(e)});
      continue;
    }
    auto bytes = batch::read_file(scratch.folder() / "monitoring_1.h5");
    if (!bytes) return tl::unexpected(bytes.error());
    made.files.push_back({fmt::format("monitoring_{}", i + 1), std::move(*bytes)});
  }
  return {};
}

}  // namespace versine::app
