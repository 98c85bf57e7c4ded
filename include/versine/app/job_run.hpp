// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "versine/app/config.hpp"
#include "versine/io/run_json.hpp"

/// What every job has in common: a place for its result, and a record of how it came about.
namespace versine::app {

/// The folder of a job's result: `output` of the command line, else the job's own `folder`, beside it, else the job's
/// name with `.result`.
[[nodiscard]] std::filesystem::path result_target(const std::filesystem::path& job, const std::filesystem::path& output,
                                                  const std::string& folder = {});

/// The beginning of a run.json: command, version, and now as its start.
[[nodiscard]] io::Run begin_run(std::string command);

/// Adds a file, or several, to the inputs of a run, with its checksum.
[[nodiscard]] Expected<void> note_file(const std::string& role, const InputPath& path,
                                       std::vector<io::RunInput>& inputs);
[[nodiscard]] Expected<void> note_files(const std::string& role, std::span<const InputPath> files,
                                        std::vector<io::RunInput>& inputs);

}  // namespace versine::app
