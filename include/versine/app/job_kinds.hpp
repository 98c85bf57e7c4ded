// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "versine/app/config.hpp"
#include "versine/core/error.hpp"

namespace versine::app {

/// A kind of job that a TOML file can describe. `init`, `check` and the pages docs/job-*.md are made from these.
struct JobKind {
  std::string_view name;     ///< the command: "survey"
  std::string_view purpose;  ///< one sentence for help and templates
  /// Describes a configuration with its defaults, for template and documentation.
  void (*describe)(ConfigVisitor&);
  /// Reads the job and what it names as far as possible without running it; returns what was found, a line each.
  Expected<std::vector<std::string>> (*check)(const std::filesystem::path& job, std::span<const std::string> overrides);
  /// A job that runs as it is, with which the template begins. Empty where a job needs files of the user's.
  std::string_view starter = {};
};

/// All kinds. A new kind is one line in src/app/job/job_kinds.cpp.
[[nodiscard]] std::span<const JobKind> job_kinds();
[[nodiscard]] const JobKind* find_job_kind(std::string_view name);

/// The kind that a job file says it is, by its key `job = "survey"`.
[[nodiscard]] Expected<const JobKind*> job_kind_of(const std::filesystem::path& job);

/// Commented template of a kind of job.
[[nodiscard]] std::string job_template(const JobKind& kind);
/// The page docs/job-<kind>.md, whole.
[[nodiscard]] std::string job_documentation(const JobKind& kind);

}  // namespace versine::app
