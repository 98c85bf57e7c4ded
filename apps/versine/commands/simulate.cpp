// SPDX-License-Identifier: Apache-2.0
#include "versine/app/simulate.hpp"

#include <cstdio>
#include <memory>

#include "command.hpp"

namespace versine::cli {

void add_simulate(CLI::App& app, int& exit) {
  CLI::App* command = app.add_subcommand("simulate", "Make a recording with known truth from a scenario");
  auto options = std::make_shared<JobOptions>();
  auto runs = std::make_shared<int>(0);
  add_job_options(*command, *options);
  command->add_option("--runs", *runs, "Recordings with the same truth and other errors (default: the scenario's)")
      ->check(CLI::Range(1, 1000000));
  command->callback([options, runs, &exit] {
    SilentProgress progress;
    const auto run = app::run_simulate(options->job, options->set, options->output, *runs, options->threads, progress);
    if (!run) {
      exit = report(run.error());
      return;
    }
    if (!options->quiet) std::printf("%s\n", (options->json ? run->summary_json : run->summary_text).c_str());
    exit = good;
  });
}

}  // namespace versine::cli
