// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "versine/app/report_config.hpp"
#include "versine/core/error.hpp"

/// `versine report`, and the report that a job makes of its own result: always from the files of a result folder, so
/// that a report never says anything else than they do.
namespace versine::app {

struct ReportRequest {
  std::vector<std::string> formats;     ///< empty: those of the job that made the result, or html
  std::optional<std::string> language;  ///< none: the job's
  std::filesystem::path output;         ///< folder for the files; empty: the result itself
  std::string shown_as;                 ///< the folder's name in the report; empty: its own
};

/// Reads a result of survey, geometry, georef or plan, and writes report.html, report.pdf, report.xlsx. Returns the
/// files. Fails, naming the cure, when the folder is empty, half, of another version, or of a job without report; no
/// file is replaced then.
[[nodiscard]] Expected<std::vector<std::filesystem::path>> write_report(const std::filesystem::path& result,
                                                                        const ReportRequest& request);
/// The document itself, without writing anything.
[[nodiscard]] Expected<report::Document> make_report(const std::filesystem::path& result, const ReportRequest& request);

/// Formats and language of a job, before its work begins.
[[nodiscard]] Expected<void> check_report(const ReportConfig& config);
/// For a job that has written its folder, run.json included, and is about to commit it: makes the report when the job
/// asks for one.
[[nodiscard]] Expected<void> write_job_report(const ReportConfig& config, const std::filesystem::path& folder,
                                              const std::filesystem::path& target);

}  // namespace versine::app
