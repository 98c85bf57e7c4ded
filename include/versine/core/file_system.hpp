// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

/// What the standard library does not offer portably.
namespace versine {

/// Exchanges two names in one step, so that no moment is without either. False where the system or the file system
/// cannot.
[[nodiscard]] bool exchange_names(const std::filesystem::path& a, const std::filesystem::path& b);
/// Writes what the system still holds of the files of a folder (not of its subfolders) to the disk.
void flush_to_disk(const std::filesystem::path& folder);
/// The same for one file, or for the names in one folder. False when the disk says it could not.
[[nodiscard]] bool flush_one(const std::filesystem::path& path);
[[nodiscard]] int process_id();
/// False when no process of that number is running; true when that cannot be told.
[[nodiscard]] bool process_runs(int id);

}  // namespace versine
