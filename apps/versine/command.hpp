// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "versine/core/error.hpp"

namespace versine::cli {

/// Exit codes of every command.
enum Exit : int {
  good = 0,          ///< done
  unacceptable = 1,  ///< the job ran and found the result unacceptable
  bad_input = 2,     ///< a file, a key or an argument is wrong
  internal = 3,      ///< a fault of Versine's own
  batch_usage = 64,  ///< of `versine batch`, which has exit codes of its own (batch/outcome.hpp)
};

/// All commands. Each declares its options and leaves a callback that sets `exit`. A new command is one file in
/// commands/, its line here and its place in main.cpp's list, which is the order of the help.
void add_batch(CLI::App& app, int& exit);
void add_axis(CLI::App& app, int& exit);
void add_calibrate(CLI::App& app, int& exit);
void add_check(CLI::App& app, int& exit);
void add_geometry(CLI::App& app, int& exit);
void add_georef(CLI::App& app, int& exit);
void add_info(CLI::App& app, int& exit);
void add_init(CLI::App& app, int& exit);
void add_network(CLI::App& app, int& exit);
void add_simulate(CLI::App& app, int& exit);
void add_survey(CLI::App& app, int& exit);
void add_compare(CLI::App& app, int& exit);
void add_gnss(CLI::App& app, int& exit);
void add_stationing(CLI::App& app, int& exit);
void add_alignment(CLI::App& app, int& exit);
/// What `versine alignment FILE` prints, and its exit code.
[[nodiscard]] int audit_alignment(const std::filesystem::path& file, bool json);
void add_plan(CLI::App& app, int& exit);
void add_view(CLI::App& app, int& exit);
void add_report(CLI::App& app, int& exit);

/// Options that every job command has.
struct JobOptions {
  std::string job;
  std::string output;
  int threads = 0;  ///< 0: all cores
  bool json = false;
  bool quiet = false;
  std::vector<std::string> set;
};
void add_job_options(CLI::App& command, JobOptions& options);

/// Prints an error on standard error and returns the exit code for bad input. What is wrong with a key of `job` names
/// that file.
int report(Error error, const std::string& job = {});

/// Prints what a job came to, as text with the place of its result or as JSON, and returns the exit code.
int print_result(const JobOptions& options, const std::string& text, const std::string& json,
                 const std::filesystem::path& folder, bool acceptable = true);

}  // namespace versine::cli
