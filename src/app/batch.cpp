// SPDX-License-Identifier: Apache-2.0
#include "versine/app/batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "versine/app/version.hpp"
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
  c.title.clear();
  c.recordings.clear();
  return io::sha256(config_json([&](ConfigVisitor& v) { describe(v, c); }) + "\n" + digests);
}

bool is_recording(const fs::path& path) {
  static constexpr std::array endings{".h5", ".hdf5", ".csv", ".pos", ".nmea", ".ubx"};
  fs::path p = path;
  if (p.extension() == ".gz" || p.extension() == ".zst") p = p.stem();
  const std::string name = path.filename().string(), ending = p.extension().string();
  return !name.starts_with(".") && std::find(endings.begin(), endings.end(), ending) != endings.end();
}

Outcome<std::vector<fs::path>> list_files(const fs::path& given) {
  std::vector<fs::path> files;
  std::error_code code;
  if (fs::is_directory(given, code)) {
    for (const auto& entry : fs::recursive_directory_iterator(given, code)) {
      if (entry.is_regular_file(code) && is_recording(entry.path())) files.push_back(entry.path());
    }
  } else {
    std::ifstream list(given);
    for (std::string line; std::getline(list, line);) {
      while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
      if (!line.empty() && line.front() != '#') files.push_back(given.parent_path() / line);
    }
  }
  std::sort(files.begin(), files.end());
  if (!files.empty()) return files;
  return failure(Exit::usage, {.file = given.string(),
                               .field = "inputs",
                               .found = "no recordings",
                               .expected = "a folder with .h5, .csv, .pos or .nmea files, or a text file of paths",
                               .advice = "name it with --inputs"});
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

Outcome<std::vector<batch::Input>> batch_inputs(const fs::path& folder_or_list, Progress& progress) {
  const auto files = list_files(fs::absolute(folder_or_list));
  if (!files) return tl::unexpected(files.error());
  std::vector<batch::Input> out;
  for (const auto& file : *files) {
    progress.report("reading inputs", static_cast<double>(out.size()) / static_cast<double>(files->size()));
    const auto path = file.lexically_normal();
    const auto input = io::describe_input("recording", path.string(), path);
    if (!input) return failure(Exit::usage, input.error());
    out.push_back({path.string(), input->sha256, input->bytes});
  }
  return out;
}

Outcome<batch::Job> batch_job(const fs::path& job) {
  auto text = batch::read_file(job);
  if (!text) return failure(Exit::usage, text.error().error);
  const auto path = fs::absolute(job);
  const auto config = read_job(*text, path);
  if (!config) return failure(Exit::usage, config.error());
  // A unit is its input's content: what names single recordings cannot be part of all units.
  for (const auto& [key, present] :
       {std::pair("monitoring", !config->monitoring.empty()), std::pair("constraints", !config->constraints.empty()),
        std::pair("recording", !config->tables.empty())}) {
    if (!present) continue;
    return failure(Exit::usage, {.file = job.string(),
                                 .field = key,
                                 .found = "tables that belong to single recordings",
                                 .expected = "a job without them",
                                 .advice = "give such recordings a job of their own ('versine georef')"});
  }
  const auto map = load_map(*config);
  if (!map) return failure(Exit::usage, map.error());
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
  const batch::Input& input = unit.inputs.front();
  if (const auto same = check_input(input); !same) return tl::unexpected(same.error());
  // The bytes are those of the manifest: what a reader cannot make sense of is bad data, wherever it is tried.
  std::vector<Error> faults;
  auto recordings = load_recordings(input.uri, faults);
  batch::Made made;
  if (!recordings) {
    made.rejection = without_path(recordings.error(), input.uri);
    return made;
  }
  batch::Summary summary;
  std::vector<georef::RecordingResult> results;
  for (const auto& f : faults) {
    const Error e = without_path(f, input.uri);
    summary.failures.push_back({e.file, e});
  }
  for (auto& r : *recordings) {
    r.name = without_path(r.name, input.uri);
    const std::string name = r.name;
    auto result = georef::georeference(*map_, std::move(r), config_.options, config_.constraints);
    if (!result) {
      summary.failures.push_back({name, without_path(result.error(), input.uri)});
      continue;
    }
    for (auto& j : journey_entries(*map_, *result)) summary.journeys.push_back(std::move(j));
    results.push_back(std::move(*result));
  }
  if (results.empty()) {
    made.rejection = summary.failures.empty() ? Error{.field = "recordings", .found = "none"}
                                              : std::move(summary.failures.front().error);
    return made;
  }
  std::vector<const georef::RecordingResult*> pointers;
  for (const auto& r : results) pointers.push_back(&r);
  made.files.push_back({"summary", batch::to_text(summary)});
  made.files.push_back({"positions", positions_table(*map_, pointers, config_.csv_interval)});
  return made;
}

}  // namespace versine::app
