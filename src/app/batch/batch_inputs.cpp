// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <fstream>

#include "versine/app/batch.hpp"
#include "versine/io/run_json.hpp"

namespace versine::app {

namespace fs = std::filesystem;
using batch::Exit;
using batch::failure;
using batch::Outcome;

namespace {
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

Outcome<batch::Input> input_of(const fs::path& path) {
  const auto input = io::describe_input("recording", path.string(), path);
  if (!input) return failure(Exit::usage, input.error());
  return batch::Input{path.string(), input->sha256, input->bytes};
}

/// The recording, its companion, and what this names.
Outcome<std::vector<batch::Input>> together(const fs::path& recording) {
  std::vector<fs::path> files{recording};
  if (const fs::path companion = companion_of(recording); fs::exists(companion)) {
    files.push_back(companion);
    const auto read = read_companion(companion);
    if (!read) return failure(Exit::usage, read.error());
    for (const auto& m : read->monitoring) files.push_back(m.file.path.lexically_normal());
  }
  std::vector<batch::Input> out;
  for (const auto& file : files) {
    auto input = input_of(file);
    if (!input) return tl::unexpected(input.error());
    out.push_back(std::move(*input));
  }
  return out;
}
}  // namespace

fs::path companion_of(const fs::path& recording) {
  return recording.string() + ".toml";
}

Outcome<std::vector<std::vector<batch::Input>>> batch_inputs(const fs::path& folder_or_list, Progress& progress) {
  const auto files = list_files(fs::absolute(folder_or_list));
  if (!files) return tl::unexpected(files.error());
  // What a companion names is no recording of its own.
  std::vector<std::vector<batch::Input>> all;
  std::vector<std::string> named;
  for (const auto& file : *files) {
    progress.report("reading inputs", static_cast<double>(all.size()) / static_cast<double>(files->size()));
    auto inputs = together(file.lexically_normal());
    if (!inputs) return tl::unexpected(inputs.error());
    for (std::size_t i = 1; i < inputs->size(); ++i) named.push_back((*inputs)[i].uri);
    all.push_back(std::move(*inputs));
  }
  std::erase_if(all, [&](const auto& inputs) {
    return std::find(named.begin(), named.end(), inputs.front().uri) != named.end();
  });
  return all;
}

}  // namespace versine::app
