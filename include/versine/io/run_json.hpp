// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/core/run_record.hpp"

namespace versine::io {

/// A file that went into a run.
struct RunInput {
  std::string role;            ///< "imu", "gnss", "job", ...
  std::string written;         ///< as the user named it
  std::filesystem::path path;  ///< where it was found
  std::uintmax_t bytes = 0;
  std::string sha256;  ///< of the file as it lies there, 64 hexadecimal digits
};

/// Size and SHA-256 of a file.
[[nodiscard]] Expected<RunInput> describe_input(std::string role, std::string written,
                                                const std::filesystem::path& path);

/// What `run.json` holds: how a result came about, so that it can be judged and repeated.
struct Run {
  std::string command;                    ///< "survey"
  std::string version;                    ///< of Versine
  std::string started_utc;                ///< ISO 8601
  TimeScale time_scale = TimeScale::gps;  ///< of the times in `record`
  std::vector<RunInput> inputs;
  std::string settings_json;                              ///< effective settings, a JSON object (app::config_json)
  std::map<std::string, std::string> libraries;           ///< name to version
  std::vector<std::pair<std::string, double>> timings_s;  ///< stage, seconds, in order
  std::string results_json = "{}";                        ///< summary of the results, a JSON object
  RunRecord record;
};

[[nodiscard]] Expected<void> write_run_json(const std::filesystem::path& path, const Run& run);
/// The same as text, for `--json`.
[[nodiscard]] std::string run_json(const Run& run);

}  // namespace versine::io
