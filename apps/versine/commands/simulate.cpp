// SPDX-License-Identifier: Apache-2.0
#include "versine/app/simulate.hpp"

#include <cstdio>
#include <memory>

#include "command.hpp"
#include "terminal.hpp"

namespace versine::cli {

namespace {
int simulate(const JobOptions& options, int runs) {
  Expected<app::SimulateRun> run = fail({});
  {
    TerminalProgress progress(options.quiet || options.json);
    run = app::run_simulate(options.job, options.set, options.output, runs, options.threads, progress);
  }
  if (!run) return report(run.error(), options.job);
  if (options.json) {
    std::printf("%s\n", run->summary_json.c_str());
  } else if (!options.quiet) {
    std::printf("%sRecording: %s\n", run->summary_text.c_str(), run->folder.string().c_str());
  }
  return good;
}
}  // namespace

void add_simulate(CLI::App& app, int& exit) {
  auto* command = app.add_subcommand("simulate", "Make a recording with known truth from a scenario");
  auto options = std::make_shared<JobOptions>();
  auto runs = std::make_shared<int>(0);
  add_job_options(*command, *options);
  command->add_option("--runs", *runs, "Recordings with the same truth and other errors (default: the scenario's)")
      ->check(CLI::Range(1, 1000000));
  command->callback([options, runs, &exit] { exit = simulate(*options, *runs); });
}

}  // namespace versine::cli
