// SPDX-License-Identifier: Apache-2.0
#include "versine/app/survey.hpp"

#include <memory>

#include "command.hpp"
#include "terminal.hpp"

namespace versine::cli {

namespace {
int survey(const JobOptions& options) {
  TerminalLog log(options.quiet || options.json);
  Expected<app::SurveyRun> run = fail({});
  {
    TerminalProgress progress(options.quiet || options.json);
    run = app::run_survey(options.job, options.set, options.output, progress, log);
  }
  if (!run) return report(run.error(), options.job);
  return print_result(options, run->summary_text, run->summary_json, run->folder);
}
}  // namespace

void add_survey(CLI::App& app, int& exit) {
  auto* command = app.add_subcommand("survey",
                                     "Process a recording of a trolley or vehicle into a trajectory with its "
                                     "uncertainty");
  auto options = std::make_shared<JobOptions>();
  add_job_options(*command, *options);
  command->callback([options, &exit] { exit = survey(*options); });
}

}  // namespace versine::cli
