// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>

#include "command.hpp"
#include "versine/app/measured_axis.hpp"

namespace versine::cli {

void add_axis(CLI::App& app, int& exit) {
  auto* command = app.add_subcommand(
      "axis", "The alignment that describes a measured track best, as LandXML, with standard deviations beside it");
  auto request = std::make_shared<app::AxisRequest>();
  command->add_option("result", request->result, "Folder of a survey or geometry result")->required();
  command->add_option("-o,--output", request->output, "LandXML to write; its elements with sigmas go to a .csv beside")
      ->required();
  command->add_option("--round-radius", request->options.round_radius, "Radii to multiples of this, m");
  command->add_option("--round-length", request->options.round_length, "Lengths of transitions to multiples, m");
  command->callback([request, &exit] {
    const auto run = app::run_axis(*request);
    if (!run) {
      exit = report(run.error());
      return;
    }
    std::printf("%sWritten: %s, %s\n", run->text.c_str(), run->landxml.c_str(), run->table.c_str());
    exit = good;
  });
}

}  // namespace versine::cli
