// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "versine/core/error.hpp"

namespace versine::io {

/// A result folder that appears whole or not at all. Files are written into a sibling, `.NAME.new-*`; `commit()` puts
/// it in the place of the old result by rename. A job that is killed leaves the old result, or the new one (between
/// the two renames of `commit()`, on file systems that cannot exchange two names, `recover` does what was left).
class ResultFolder {
 public:
  /// Makes the sibling, after removing what killed jobs left beside `target`. Fails when `target` is a file, when it
  /// is a folder that holds anything but a Versine result (no run.json), or when its parent cannot be written.
  [[nodiscard]] static Expected<ResultFolder> create(const std::filesystem::path& target);

  ResultFolder(ResultFolder&& other) noexcept;
  ResultFolder& operator=(ResultFolder&&) = delete;
  ~ResultFolder();  ///< removes the sibling unless committed

  /// Where to write: a path inside the sibling.
  [[nodiscard]] std::filesystem::path path(const std::filesystem::path& name) const { return folder_ / name; }
  /// The same for what people look at while the job runs, and what is no part of the result: `commit` removes it.
  [[nodiscard]] std::filesystem::path scratch(const std::filesystem::path& name) {
    scratch_.push_back(folder_ / name);
    return scratch_.back();
  }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const std::filesystem::path& target() const { return target_; }

  /// Flushes the files to the disk and puts the folder in place of `target`.
  [[nodiscard]] Expected<void> commit();

 private:
  ResultFolder(std::filesystem::path target, std::filesystem::path folder)
      : target_(std::move(target)), folder_(std::move(folder)) {}
  std::filesystem::path target_, folder_;
  std::vector<std::filesystem::path> scratch_;
};

}  // namespace versine::io
