// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "versine/batch/outcome.hpp"

namespace versine::batch {

/// A folder of results by content. Any number of processes on any number of machines write into it at once; each file
/// appears by rename or link, whole or not at all.
///
///     manifests/<id>/{manifest.json, units.jsonl}    objects/ab/<sha256>    receipts/ab/<unit>.json
///     logs/<id>.jsonl (advisory)                     tmp/ (same file system)
class Store {
 public:
  /// Opens a store, or makes it. Fails (64) where it is no store and `make` is not set.
  [[nodiscard]] static Outcome<Store> open(const std::filesystem::path& folder, bool make);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] std::filesystem::path manifests() const { return folder_ / "manifests"; }
  [[nodiscard]] std::filesystem::path objects() const { return folder_ / "objects"; }
  [[nodiscard]] std::filesystem::path receipts() const { return folder_ / "receipts"; }
  [[nodiscard]] std::filesystem::path log(const std::string& manifest) const;
  [[nodiscard]] std::filesystem::path tmp() const { return folder_ / "tmp"; }
  [[nodiscard]] std::filesystem::path object(const std::string& sha256) const;
  [[nodiscard]] std::filesystem::path receipt(const std::string& unit) const;

  /// A new file in tmp/ with this content, on the disk. The caller renames, links or removes it.
  [[nodiscard]] Outcome<std::filesystem::path> write_tmp(std::string_view bytes) const;
  /// Puts an object; its name is its SHA-256. Putting it again is harmless and mends a damaged one.
  [[nodiscard]] Outcome<std::string> put(std::string_view bytes) const;
  /// An object, if its content still has its name. Fails (75) when it is missing or damaged.
  [[nodiscard]] Outcome<std::string> get(const std::string& sha256) const;

 private:
  explicit Store(std::filesystem::path folder) : folder_(std::move(folder)) {}
  std::filesystem::path folder_;
};

/// A whole small file. Fails (75) when it cannot be read.
[[nodiscard]] Outcome<std::string> read_file(const std::filesystem::path& path);

}  // namespace versine::batch
