// SPDX-License-Identifier: Apache-2.0
#include "versine/app/job_run.hpp"

#include <chrono>

#include "versine/app/version.hpp"
#include "versine/core/calendar.hpp"

namespace versine::app {

std::filesystem::path result_target(const std::filesystem::path& job, const std::filesystem::path& output,
                                    const std::string& folder) {
  if (!output.empty()) return output;
  return folder.empty() ? std::filesystem::path(job).replace_extension(".result") : job.parent_path() / folder;
}

io::Run begin_run(std::string command) {
  const auto now = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  return {.command = std::move(command),
          .version = version(),
          .started_utc = to_text({std::chrono::nanoseconds(now.time_since_epoch()).count()}, TimeScale::utc)};
}

Expected<void> note_file(const std::string& role, const InputPath& path, std::vector<io::RunInput>& inputs) {
  auto file = io::describe_input(role, path.written, path.path);
  if (!file) return tl::unexpected(file.error());
  inputs.push_back(std::move(*file));
  return {};
}

Expected<void> note_files(const std::string& role, std::span<const InputPath> files,
                          std::vector<io::RunInput>& inputs) {
  for (const InputPath& file : files) {
    if (auto done = note_file(role, file, inputs); !done) return done;
  }
  return {};
}

}  // namespace versine::app
