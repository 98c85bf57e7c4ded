// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "command.hpp"
#include "terminal.hpp"
#include "versine/app/positioning_jobs.hpp"

namespace versine::cli {

namespace {
using Job = decltype(app::run_gnss);

int run(Job& job, const JobOptions& options) {
  TerminalLog log(options.quiet || options.json);
  Expected<app::PositioningRun> done = fail({});
  {
    TerminalProgress progress(options.quiet || options.json);
    done = job(options.job, options.set, options.output, progress, log);
  }
  if (!done) return report(done.error(), options.job);
  return print_result(options, done->summary_text, done->summary_json, done->folder);
}

void add(CLI::App& app, int& exit, const char* name, const char* purpose, Job& job) {
  auto* command = app.add_subcommand(name, purpose);
  auto options = std::make_shared<JobOptions>();
  add_job_options(*command, *options);
  command->callback([options, &job, &exit] { exit = run(job, *options); });
}
}  // namespace

void add_gnss(CLI::App& app, int& exit) {
  add(app, exit, "gnss", "Observations of a rover and a base become carrier-phase positions, through RTKLIB",
      versine::app::run_gnss);
}

void add_stationing(CLI::App& app, int& exit) {
  add(app, exit, "stationing", "Raw total-station readings become stations, landmarks and an adjusted network",
      versine::app::run_stationing);
}

}  // namespace versine::cli
