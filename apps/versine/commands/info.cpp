// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>

#include "command.hpp"
#include "versine/app/recording_info.hpp"
#include "versine/io/alignment_file.hpp"

namespace versine::cli {

void add_info(CLI::App& app, int& exit) {
  struct Options {
    std::vector<std::string> files;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("info", "What is in a recording: format, columns, rate, gaps, units guessed");
  command
      ->add_option("file", options->files,
                   "CSV, RTKLIB .pos, NMEA or trajectory.h5; plain, gzip or zstd; LandXML or DB TRA")
      ->required();
  command->add_flag("--json", options->json, "Print JSON");
  command->footer(
      "Example: versine info imu.csv.zst\nColumns marked '(not by itself)' are read when [columns] of the job names "
      "them, with their unit.");
  command->callback([options, &exit] {
    for (const std::string& file : options->files) {
      if (io::is_alignment(file)) {
        exit = audit_alignment(file, options->json);
        continue;
      }
      const auto info = app::recording_info(file);
      if (!info) {
        exit = report(info.error());
        continue;
      }
      std::puts((options->json ? app::to_json(*info) : app::to_text(*info)).c_str());
    }
  });
}

}  // namespace versine::cli
