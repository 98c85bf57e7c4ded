// SPDX-License-Identifier: Apache-2.0
#include "versine/app/georef.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>

#include "command.hpp"

namespace versine::cli {

namespace {

int run(const JobOptions& options, bool online) {
  app::GeorefConfig config;
  config.run_online = online;
  const auto read = app::read_config(
      options.job, [&](app::ConfigVisitor& v) { app::describe(v, config); }, options.set);
  if (!read) return report(read.error());
  std::filesystem::path folder = options.output;
  if (folder.empty()) folder = std::filesystem::path(options.job).replace_extension("");
  SilentProgress progress;
  const auto summary = app::run_georef(config, std::filesystem::absolute(folder), progress);
  if (!summary) return report(summary.error());
  for (const auto& f : summary->faults) report(f);
  std::size_t journeys = 0, failed = 0;
  for (const auto& o : summary->outcomes) {
    if (!o.result)
      report(o.result.error()), ++failed;
    else
      journeys += o.result->journeys.size();
  }
  if (options.json) {
    std::FILE* file = std::fopen((folder / "run.json").c_str(), "r");
    for (int c = file != nullptr ? std::fgetc(file) : EOF; c != EOF; c = std::fgetc(file)) std::putchar(c);
    if (file != nullptr) std::fclose(file);
  } else if (!options.quiet) {
    std::printf(
        "%zu recordings, %zu journeys, %zu failed; map %.2f s, journeys %.2f s, writing %.2f s; results in %s\n",
        summary->outcomes.size(), journeys, failed, summary->seconds_map, summary->seconds_solve,
        summary->seconds_write, folder.c_str());
    for (const auto& replay : summary->online) std::printf("%s", app::online_text(replay).c_str());
  }
  return failed == 0 && summary->faults.empty() ? good : unacceptable;
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
