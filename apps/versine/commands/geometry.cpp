// SPDX-License-Identifier: Apache-2.0
#include "versine/app/geometry.hpp"

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
  if (!run) return report(run.error(), options.job);
  return print_result(options, run->summary_text, run->summary_json, run->folder, run->acceptable);
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
