// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>

#include "command.hpp"
#include "terminal.hpp"
#include "versine/app/positioning_jobs.hpp"

namespace versine::cli {

namespace {
int run(const JobOptions& options) {
  TerminalLog log(options.quiet || options.json);
  Expected<app::PositioningRun> done = fail({});
  {
    TerminalProgress progress(options.quiet || options.json);
    done = app::run_stationing(options.job, options.set, options.output, progress, log);
  }
  if (!done) return report(done.error());
  if (options.json) {
    std::printf("%s\n", done->summary_json.c_str());
  } else if (!options.quiet) {
    std::printf("%sResult: %s\n", done->summary_text.c_str(), done->folder.string().c_str());
  }
  return good;
}
}  // namespace

void add_stationing(CLI::App& app, int& exit) {
  auto* command =
      app.add_subcommand("stationing", "Raw total-station readings become stations, landmarks and an adjusted network");
  auto options = std::make_shared<JobOptions>();
  add_job_options(*command, *options);
  command->callback([options, &exit] { exit = run(*options); });
}

}  // namespace versine::cli
