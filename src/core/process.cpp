// SPDX-License-Identifier: Apache-2.0
#include "versine/core/process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <vector>

extern char** environ;

namespace versine {

std::optional<std::filesystem::path> find_program(std::string_view name) {
  const char* path = std::getenv("PATH");
  std::string_view folders = path == nullptr ? "/usr/local/bin:/usr/bin:/bin" : path;
  while (!folders.empty()) {
    const auto end = std::min(folders.find(':'), folders.size());
    const auto candidate = std::filesystem::path(folders.substr(0, end)) / name;
    std::error_code ignored;
    if (end > 0 && std::filesystem::is_regular_file(candidate, ignored) && access(candidate.c_str(), X_OK) == 0) {
      return candidate;
    }
    folders.remove_prefix(std::min(end + 1, folders.size()));
  }
  return {};
}

namespace {

/// Splits what comes through the pipe at line ends; false when `line` asked to stop.
bool take_output(std::string_view piece, std::string& pending, const std::function<bool(std::string_view)>& line) {
  pending += piece;
  std::size_t from = 0;
  for (std::size_t end; (end = pending.find_first_of("\r\n", from)) != std::string::npos; from = end + 1) {
    if (end > from && !line(std::string_view(pending).substr(from, end - from))) return false;
  }
  pending.erase(0, from);
  return true;
}

Error failure(const std::filesystem::path& program, int code) {
  return {.file = program.string(),
          .found = std::strerror(code),
          .expected = "a program that can be started",
          .advice = "is it installed, and may it be executed?"};
}

}  // namespace

Expected<ProcessResult> run_process(const std::filesystem::path& program, std::span<const std::string> arguments,
                                    const std::function<bool(std::string_view)>& line) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return fail(failure(program, errno));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 2);
  std::string name = program.string();
  std::vector<std::string> copies(arguments.begin(), arguments.end());
  std::vector<char*> argv{name.data()};
  for (auto& a : copies) argv.push_back(a.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  const int started = posix_spawn(&child, name.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (started != 0) {
    close(ends[0]);
    return fail(failure(program, started));
  }
  ProcessResult result;
  std::string pending;
  bool going = true;
  char buffer[4096];
  for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) != 0;) {
    if (n < 0) {
      if (errno == EINTR) continue;
      break;
    }
    const std::string_view piece(buffer, static_cast<std::size_t>(n));
    result.output += piece;
    if (result.output.size() > 1 << 17) result.output.erase(0, result.output.size() - (1 << 16));
    if (going && !take_output(piece, pending, line)) {
      going = false;
      kill(child, SIGTERM);
    }
  }
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!going) return fail({.file = name, .found = "cancelled"});
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

}  // namespace versine
