// SPDX-License-Identifier: Apache-2.0
#include "versine/app/georef.hpp"

#include <memory>

#include "command.hpp"
#include "terminal.hpp"

namespace versine::cli {

namespace {

int run(const JobOptions& options, bool online) {
  Expected<app::GeorefRun> done = fail({});
  {
    TerminalProgress progress(options.quiet || options.json);
    done = app::run_georef(options.job, options.set, options.output, options.threads, online, progress);
  }
  if (!done) return report(done.error(), options.job);
  for (const auto& f : done->faults) report(f);
  return print_result(options, done->summary_text, done->summary_json, done->folder, done->faults.empty());
}

}  // namespace

void add_georef(CLI::App& app, int& exit) {
  auto* command = app.add_subcommand("georef", "Put an in-service vehicle's recordings on the tracks of a map");
  const auto options = std::make_shared<JobOptions>();
  add_job_options(*command, *options);
  const auto online = std::make_shared<bool>(false);
  command->add_flag("--online", *online, "Also replay the recordings sample by sample: latency, difference to offline");
  command->callback([options, online, &exit] { exit = run(*options, *online); });
}

}  // namespace versine::cli
