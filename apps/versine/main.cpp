// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <string_view>

#include "command.hpp"
#include "versine/app/job_kinds.hpp"
#include "versine/app/version.hpp"

namespace versine::cli {

void add_job_options(CLI::App& command, JobOptions& options) {
  // What else is wrong with a job is for its own command to tell.
  const auto of_this_kind = [kind = command.get_name()](const std::string& file) -> std::string {
    const auto found = app::job_kind_of(file);
    if (!found || (*found)->name == kind) return {};
    const std::string name((*found)->name);
    return file + " is a " + name + " job; run it with: versine " + name + " " + file;
  };
  command.add_option("job", options.job, "Job file (TOML)")->required()->check(of_this_kind);
  command.add_option("-o,--output", options.output, "Result folder (default: beside the job, named after it)");
  command.add_option("--threads", options.threads, "Threads; 0 means all cores")->check(CLI::Range(0, 1024));
  command.add_flag("--json", options.json, "Print a machine-readable summary");
  command.add_flag("--quiet", options.quiet, "Print nothing but errors");
  command.add_option("--set", options.set, "Override a key of the job: --set output.rate_hz=10")
      ->type_name("KEY=VALUE")
      ->take_all();
}

int report(Error error, const std::string& job) {
  if (error.file.empty() && !error.field.empty()) error.file = job;
  std::fprintf(stderr, "versine: %s\n", error.message().c_str());
  return bad_input;
}

int print_result(const JobOptions& options, const std::string& text, const std::string& json,
                 const std::filesystem::path& folder, bool acceptable) {
  if (options.json) {
    std::printf("%s\n", json.c_str());
  } else if (!options.quiet) {
    std::printf("%s%sResult: %s\n", text.c_str(), text.ends_with("\n") || text.empty() ? "" : "\n",
                folder.string().c_str());
  }
  return acceptable ? good : unacceptable;
}

}  // namespace versine::cli

int main(int argc, char** argv) {
  using namespace versine::cli;
  CLI::App app{
      "Versine turns recordings from rails into positions and track geometry, with the uncertainty of every "
      "number.\n\nStart with a template:  versine init survey > job.toml\nthen:                   versine "
      "check job.toml && versine survey job.toml"};
  app.set_version_flag("--version", "versine " + versine::app::version());
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  int exit = good;
  for (const auto add :
       {add_init, add_check, add_info, add_simulate, add_survey, add_geometry, add_calibrate, add_gnss, add_stationing,
        add_plan, add_report, add_view, add_compare, add_alignment, add_axis, add_georef, add_batch, add_network}) {
    add(app, exit);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool batch = argc > 1 && std::string_view(argv[1]) == "batch";  // engines read its exit codes
    return app.exit(error) == 0 ? good : batch ? batch_usage : bad_input;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "versine: internal error: %s\n  please report this with the job file and the command\n",
                 error.what());
    return internal;
  }
  return exit;
}
