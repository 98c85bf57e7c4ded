// SPDX-License-Identifier: Apache-2.0
#include "versine/app/plan.hpp"

#include <memory>

#include "command.hpp"
#include "terminal.hpp"

namespace versine::cli {

namespace {
int plan(const JobOptions& options, int monte_carlo) {
  Expected<app::PlanRun> run = fail({});
  {
    TerminalProgress progress(options.quiet || options.json);
    run = app::run_plan(options.job, options.set, options.output, monte_carlo, options.threads, progress);
  }
  if (!run) return report(run.error(), options.job);
  return print_result(options, run->summary_text, run->summary_json, run->folder, run->met);
}
}  // namespace

void add_plan(CLI::App& app, int& exit) {
  auto* command = app.add_subcommand(
      "plan", "Predict the accuracy of a survey from its sensors and landmarks; which gyro, which spacing will do");
  auto options = std::make_shared<JobOptions>();
  auto monte_carlo = std::make_shared<int>(-1);
  add_job_options(*command, *options);
  command->add_option("--monte-carlo", *monte_carlo, "Simulated runs through the real filters (default: the job's)")
      ->check(CLI::Range(0, 1000000))
      ->type_name("N");
  command->footer("Exit code 0: the required accuracy is met; 1: it is not; 2: bad input.");
  command->callback([options, monte_carlo, &exit] { exit = plan(*options, *monte_carlo); });
}

}  // namespace versine::cli
