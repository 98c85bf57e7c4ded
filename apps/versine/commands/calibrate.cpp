// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "command.hpp"
#include "terminal.hpp"
#include "versine/app/geometry.hpp"

namespace versine::cli {

namespace {
int calibrate(const JobOptions& options) {
  Expected<app::GeometryRun> run = fail({});
  {
    TerminalProgress progress(options.quiet || options.json);
    run = app::run_calibrate(options.job, options.set, options.output, progress);
  }
  if (!run) return report(run.error(), options.job);
  return print_result(options, run->summary_text, run->summary_json, run->folder, run->acceptable);
}
}  // namespace

void add_calibrate(CLI::App& app, int& exit) {
  auto* command =
      app.add_subcommand("calibrate", "Mounting angles from passes in both orientations, and repeatability of runs");
  auto options = std::make_shared<JobOptions>();
  add_job_options(*command, *options);
  command->callback([options, &exit] { exit = calibrate(*options); });
}

}  // namespace versine::cli
