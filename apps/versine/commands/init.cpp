// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>

#include "command.hpp"
#include "versine/app/job_kinds.hpp"

namespace versine::cli {

void add_init(CLI::App& app, int&) {
  auto* command = app.add_subcommand("init", "Write a commented job file: versine init survey > job.toml");
  struct Options {
    std::string kind = "survey";
    bool keys = false;
  };
  auto options = std::make_shared<Options>();
  std::vector<std::string> kinds;
  std::string purposes;
  for (const app::JobKind& kind : app::job_kinds()) {
    kinds.emplace_back(kind.name);
    purposes += "\n  " + std::string(kind.name) + ": " + std::string(kind.purpose);
  }
  command->add_option("kind", options->kind, "What the job does")->check(CLI::IsMember(kinds))->capture_default_str();
  command->add_flag("--keys", options->keys, "Print every key with unit, default, range and meaning, as Markdown");
  command->footer("Kinds:" + purposes);
  command->callback([options] {
    const app::JobKind& kind = *app::find_job_kind(options->kind);
    const std::string text = options->keys ? app::job_documentation(kind) : app::job_template(kind);
    std::fwrite(text.data(), 1, text.size(), stdout);
  });
}

}  // namespace versine::cli
