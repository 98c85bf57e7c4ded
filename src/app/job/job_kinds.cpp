// SPDX-License-Identifier: Apache-2.0
#include "versine/app/job_kinds.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>

#include "versine/app/geometry_job.hpp"
#include "versine/app/georef.hpp"
#include "versine/app/plan.hpp"
#include "versine/app/positioning_jobs.hpp"
#include "versine/app/simulate_job.hpp"
#include "versine/app/survey_job.hpp"

namespace versine::app {

namespace {
std::string names() {
  std::string text;
  for (const JobKind& kind : job_kinds()) text += fmt::format("{}'{}'", text.empty() ? "" : ", ", kind.name);
  return text;
}
}  // namespace

std::span<const JobKind> job_kinds() {
  static const std::array kinds{survey_job,     geometry_job, calibrate_job, gnss_job,
                                stationing_job, georef_job,   simulate_job,  plan_job};
  return kinds;
}

const JobKind* find_job_kind(std::string_view name) {
  const auto kinds = job_kinds();
  const auto it = std::find_if(kinds.begin(), kinds.end(), [&](const JobKind& kind) { return kind.name == name; });
  return it == kinds.end() ? nullptr : &*it;
}

Expected<const JobKind*> job_kind_of(const std::filesystem::path& job) {
  std::string name;
  if (!std::filesystem::is_regular_file(job)) {
    return fail({.file = job.string(),
                 .found = "no file that can be read",
                 .expected = "a job file in TOML",
                 .advice = "'versine init survey > job.toml' writes a commented template"});
  }
  try {
    name = toml::parse_file(job.string())["job"].value_or(std::string());
  } catch (const toml::parse_error& error) {
    return fail({.file = job.string(),
                 .line = error.source().begin.line,
                 .found = std::string(error.description()),
                 .expected = "a TOML file"});
  }
  const JobKind* kind = find_job_kind(name);
  if (kind == nullptr) {
    return fail({.file = job.string(),
                 .field = "job",
                 .found = name.empty() ? "nothing" : "'" + name + "'",
                 .expected = "one of " + names(),
                 .advice = "write job = \"survey\" (or another kind) as the first line"});
  }
  return kind;
}

std::string job_template(const JobKind& kind) {
  const std::string head = fmt::format(
      "# {}\n# Keys that are commented out show their default. Every key: 'versine init {} --keys' or docs/job-{}.md.\n"
      "# Paths are relative to this file; ${{VERSINE_DATA}} stands for the folder that the variable of that name "
      "holds.\n\n",
      kind.purpose, kind.name, kind.name);
  std::string keys = config_template(kind.describe);
  if (!kind.starter.empty()) {
    return fmt::format("{}{}\n# Everything else that can be said:\n\n{}", head, kind.starter, commented_out(keys));
  }
  // The kind is a default in its own command, but 'check' and people need to read it.
  const std::string hidden = fmt::format("# job = \"{}\"", kind.name);
  if (const auto at = keys.find(hidden); at != std::string::npos) keys.erase(at, 2);
  return head + keys;
}

std::string job_documentation(const JobKind& kind) {
  return fmt::format(
      "# Keys of a `{0}` job\n\n{1}\n\nMade by `versine init {0} --keys`; a test keeps it equal to the program. "
      "Paths are relative to the job file; `${{VERSINE_DATA}}` stands for the folder that the environment variable of "
      "that name holds. Unknown keys are errors. `--set table.key=value` overrides a key from the command line.\n\n{2}",
      kind.name, kind.purpose, config_documentation(kind.describe));
}

}  // namespace versine::app
