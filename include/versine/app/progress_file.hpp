// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "versine/core/progress.hpp"
#include "versine/io/result_folder.hpp"

namespace versine::app {

/// Passes progress on and keeps a small file of it in the folder that a job is writing, for `versine view`: stage,
/// fraction, seconds so far, and the stages that are done. Each state replaces the last by rename, at most four times
/// a second and at every change of stage; a full disk is not this file's business.
class ProgressFile final : public Progress {
 public:
  static constexpr const char* name = "progress.json";

  ProgressFile(Progress& next, io::ResultFolder& folder) : next_(next), path_(folder.scratch(name)) {}
  void report(std::string_view stage, double fraction) override;
  [[nodiscard]] bool cancelled() const override { return next_.cancelled(); }
  /// What a person should know before the end: "imu: 2 x gap, split".
  void note(std::string text);

 private:
  void write();
  using Clock = std::chrono::steady_clock;
  Progress& next_;
  std::filesystem::path path_;
  std::string stage_;
  double fraction_ = 0.0;
  Clock::time_point started_ = Clock::now(), stage_started_ = started_, written_{};
  std::vector<std::pair<std::string, double>> done_;
  std::vector<std::string> notes_;
};

/// Passes messages on and notes them in the progress file.
class NotedLog final : public Log {
 public:
  NotedLog(Log& next, ProgressFile& file) : next_(next), file_(file) {}
  void info(std::string_view text) override {
    next_.info(text);
    file_.note(std::string(text));
  }
  void warn(std::string_view text) override {
    next_.warn(text);
    file_.note(std::string(text));
  }

 private:
  Log& next_;
  ProgressFile& file_;
};

/// The folder that a running job is writing for `target`; nothing when no such process is alive.
[[nodiscard]] std::optional<std::filesystem::path> running_job(const std::filesystem::path& target);

}  // namespace versine::app
