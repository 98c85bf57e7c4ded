// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <string>

#include "versine/core/progress.hpp"

namespace versine::cli {

/// A progress line on a terminal, with the remaining time of a stage; silent in a pipe and with --quiet.
/// SIGINT and SIGTERM cancel: the old result stays.
class TerminalProgress final : public Progress {
 public:
  explicit TerminalProgress(bool quiet);
  ~TerminalProgress() override;
  TerminalProgress(const TerminalProgress&) = delete;
  TerminalProgress& operator=(const TerminalProgress&) = delete;
  void report(std::string_view stage, double fraction) override;
  [[nodiscard]] bool cancelled() const override;

 private:
  using Clock = std::chrono::steady_clock;
  bool shown_;
  std::string stage_;
  Clock::time_point started_, drawn_;
};

/// Warnings and messages on standard error.
class TerminalLog final : public Log {
 public:
  explicit TerminalLog(bool quiet) : quiet_(quiet) {}
  void info(std::string_view text) override;
  void warn(std::string_view text) override;

 private:
  bool quiet_;
};

}  // namespace versine::cli
