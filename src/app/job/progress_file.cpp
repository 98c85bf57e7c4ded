// SPDX-License-Identifier: Apache-2.0
#include "versine/app/progress_file.hpp"

#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>

#include "versine/core/file_system.hpp"

namespace versine::app {

namespace fs = std::filesystem;

void ProgressFile::report(std::string_view stage, double fraction) {
  next_.report(stage, fraction);
  const auto now = Clock::now();
  const bool changed = stage != stage_;
  if (changed) {
    if (!stage_.empty()) done_.emplace_back(stage_, std::chrono::duration<double>(now - stage_started_).count());
    stage_ = stage;
    stage_started_ = now;
  }
  fraction_ = fraction;
  if (changed || now - written_ > std::chrono::milliseconds(250)) write();
}

void ProgressFile::note(std::string text) {
  notes_.push_back(std::move(text));
  write();
}

void ProgressFile::write() {
  written_ = Clock::now();
  nlohmann::ordered_json state{{"stage", stage_},
                               {"fraction", fraction_},
                               {"seconds", std::chrono::duration<double>(written_ - started_).count()},
                               {"stages", nlohmann::ordered_json::array()},
                               {"notes", notes_}};
  for (const auto& [stage, seconds] : done_) state["stages"].push_back({{"stage", stage}, {"seconds", seconds}});
  const fs::path part = fs::path(path_).concat(".part");
  std::error_code code;
  {
    std::ofstream file(part, std::ios::binary);
    file << state.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    if (!file.flush()) return;
  }
  fs::rename(part, path_, code);
}

std::optional<fs::path> running_job(const fs::path& target) {
  const std::string start = "." + target.filename().string() + ".new-";
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(target.parent_path(), code)) {
    const std::string file = entry.path().filename().string();
    if (!file.starts_with(start)) continue;
    int id = 0;
    std::from_chars(file.data() + start.size(), file.data() + file.size(), id);
    if (id > 0 && process_runs(id)) return entry.path();
  }
  return std::nullopt;
}

}  // namespace versine::app
