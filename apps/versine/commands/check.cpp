// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "versine/app/job_kinds.hpp"

namespace versine::cli {

namespace {
struct CheckOptions {
  std::string job;
  std::vector<std::string> set;
  bool json = false;
};

int check(const CheckOptions& options) {
  const auto kind = app::job_kind_of(options.job);
  if (!kind) return report(kind.error());
  const auto lines = (*kind)->check(options.job, options.set);
  if (options.json) {
    nlohmann::json out{{"job", options.job}, {"kind", (*kind)->name}, {"good", lines.has_value()}};
    if (lines) {
      out["found"] = *lines;
    } else {
      out["error"] = lines.error().message();
    }
    std::printf("%s\n", out.dump(2).c_str());
    return lines ? good : bad_input;
  }
  if (!lines) return report(lines.error(), options.job);
  for (const std::string& line : *lines) std::printf("%s\n", line.c_str());
  std::printf("%s is a good %s job; run it with: versine %s %s\n", options.job.c_str(),
              std::string((*kind)->name).c_str(), std::string((*kind)->name).c_str(), options.job.c_str());
  return good;
}
}  // namespace

void add_check(CLI::App& app, int& exit) {
  auto* command = app.add_subcommand("check", "Validate a job file and what it names, without running it");
  auto options = std::make_shared<CheckOptions>();
  command->add_option("job", options->job, "Job file (TOML)")->required();
  command->add_option("--set", options->set, "Override a key of the job")->type_name("KEY=VALUE")->take_all();
  command->add_flag("--json", options->json, "Print the outcome as JSON");
  command->callback([options, &exit] { exit = check(*options); });
}

}  // namespace versine::cli
