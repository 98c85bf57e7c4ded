// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "versine/app/job_kinds.hpp"
#include "versine/core/progress.hpp"

namespace versine::app {

extern const JobKind gnss_job;        ///< `versine gnss`: table [gnss]
extern const JobKind stationing_job;  ///< `versine stationing`: tables [total_station], [network]

struct PositioningRun {
  std::filesystem::path folder;
  std::string summary_text, summary_json;
};

/// Runs a GNSS job; the result folder holds gnss.csv (as a survey reads it) and run.json.
[[nodiscard]] Expected<PositioningRun> run_gnss(const std::filesystem::path& job,
                                                std::span<const std::string> overrides,
                                                const std::filesystem::path& output, Progress& progress, Log& log);

/// Runs a stationing job; the result folder holds landmarks.csv (as a survey reads it), stations.csv, targets.csv, with
/// [network] adjust = true also points.csv, and run.json.
[[nodiscard]] Expected<PositioningRun> run_stationing(const std::filesystem::path& job,
                                                      std::span<const std::string> overrides,
                                                      const std::filesystem::path& output, Progress& progress,
                                                      Log& log);

}  // namespace versine::app
