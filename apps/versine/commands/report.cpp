// SPDX-License-Identifier: Apache-2.0
#include "versine/app/report.hpp"

#include <cstdio>
#include <memory>

#include "command.hpp"

namespace versine::cli {

namespace {

struct ReportOptions {
  std::string result, output, language;
  std::vector<std::string> formats;
  bool quiet = false;
};

int make_report(const ReportOptions& options) {
  app::ReportRequest request{.formats = options.formats, .output = options.output};
  if (!options.language.empty()) request.language = options.language;
  const auto files = app::write_report(options.result, request);
  if (!files) return report(files.error());
  for (const auto& file : *files) {
    if (!options.quiet) std::printf("Report: %s\n", file.string().c_str());
  }
  return good;
}

}  // namespace

void add_report(CLI::App& app, int& exit) {
  auto* command = app.add_subcommand(
      "report", "Report of a result of survey, geometry, georef or plan: HTML that prints to A4, PDF, tables as XLSX");
  auto options = std::make_shared<ReportOptions>();
  command->add_option("result", options->result, "Result folder")->required();
  command->add_option("--format", options->formats, "Some of html,pdf,xlsx (default: the job's, or html)")
      ->delimiter(',');
  command->add_option("--language", options->language, "en, de, zh, or a file of texts (default: the job's, or en)");
  command->add_option("-o,--output", options->output, "Folder for the files (default: the result)");
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  command->callback([options, &exit] { exit = make_report(*options); });
}

}  // namespace versine::cli
