// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "versine/core/error.hpp"

namespace versine {

/// A program found on PATH; nothing when there is none of that name.
[[nodiscard]] std::optional<std::filesystem::path> find_program(std::string_view name);

/// How a child process ended.
struct ProcessResult {
  int exit_code = 0;   ///< 128 + signal when it was killed
  std::string output;  ///< the last 64 KiB of what it wrote on standard output and standard error
};

/// Runs a program without a shell, with nothing on its standard input, and waits. `line` is called for each piece of
/// output that ends in a newline or a carriage return; when it returns false the child is ended and the call returns
/// an Error with `found = "cancelled"`. Safe to call from several threads at once.
[[nodiscard]] Expected<ProcessResult> run_process(const std::filesystem::path& program,
                                                  std::span<const std::string> arguments,
                                                  const std::function<bool(std::string_view)>& line);

}  // namespace versine
