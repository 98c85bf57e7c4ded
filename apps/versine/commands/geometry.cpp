// SPDX-License-Identifier: Apache-2.0
#include "versine/app/geometry.hpp"

#include <cstdio>
#include <memory>

#include "command.hpp"
#include "terminal.hpp"

namespace versine::cli {

namespace {
int geometry(const JobOptions& options) {
  Expected<app::GeometryRun> run = fail({});
  {
    TerminalProgress progress(options.quiet || options.json);
    run = app::run_geometry(options.job, options.set, options.output, progress);
  }
  if (!run) return report(run.error());
  if (options.json) {
    std::printf("%s\n", run->summary_json.c_str());
  } else if (!options.quiet) {
    std::printf("%sResult: %s\n", run->summary_text.c_str(), run->folder.string().c_str());
  }
  return run->acceptable ? good : unacceptable;
}
}  // namespace

void add_geometry(CLI::App& app, int& exit) {
  auto* command = app.add_subcommand(
      "geometry",
      "Track geometry from a trajectory of this or other software (exit 1: the severest limit is exceeded)");
  auto options = std::make_shared<JobOptions>();
  add_job_options(*command, *options);
  command->callback([options, &exit] { exit = geometry(*options); });
}

}  // namespace versine::cli
