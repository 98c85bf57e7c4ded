// SPDX-License-Identifier: Apache-2.0
#include "versine/io/result_folder.hpp"

#include <fmt/format.h>

#include <charconv>
#include <system_error>
#include <vector>

#include "versine/core/file_system.hpp"

namespace versine::io {

namespace fs = std::filesystem;

namespace {
Error trouble(const fs::path& path, std::string found, std::string advice) {
  return {.file = path.string(),
          .found = std::move(found),
          .expected = "a folder that can be written",
          .advice = std::move(advice)};
}

// Siblings that earlier jobs for this target left: ".NAME.new-PROCESS" or ".NAME.old-PROCESS".
std::vector<fs::path> leftovers(const fs::path& target, const char* kind) {
  const std::string start = fmt::format(".{}.{}-", target.filename().string(), kind);
  std::vector<fs::path> found;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(target.parent_path(), code)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(start)) continue;
    int id = 0;
    std::from_chars(name.data() + start.size(), name.data() + name.size(), id);
    if (id == process_id() || !process_runs(id)) found.push_back(entry.path());
  }
  return found;
}

fs::path sibling(const fs::path& target, const char* kind) {
  return target.parent_path() / fmt::format(".{}.{}-{}", target.filename().string(), kind, process_id());
}
}  // namespace

Expected<ResultFolder> ResultFolder::create(const fs::path& given) {
  std::error_code code;
  fs::path target = fs::absolute(given, code).lexically_normal();
  if (!target.has_filename()) target = target.parent_path();
  if (fs::exists(target, code) && !fs::is_directory(target, code)) {
    return fail(trouble(given, "a file of that name", "choose another result folder (--output)"));
  }
  if (fs::is_directory(target, code) && !fs::is_empty(target, code) && !fs::exists(target / "run.json", code)) {
    return fail(trouble(given, "a folder with other content and no run.json",
                        "choose another result folder (--output), so that nothing of yours is overwritten"));
  }
  fs::create_directories(target.parent_path(), code);
  if (code) return fail(trouble(given, code.message(), "choose a result folder where you may write (--output)"));
  const auto old = leftovers(target, "old");
  if (!old.empty() && !fs::exists(target, code)) fs::rename(old.front(), target, code);  // killed between two renames
  for (const char* kind : {"new", "old"}) {
    for (const fs::path& path : leftovers(target, kind)) fs::remove_all(path, code);
  }
  const fs::path folder = sibling(target, "new");
  if (!fs::create_directory(folder, code) || code) {
    return fail(trouble(given, code ? code.message() : "a leftover that cannot be removed",
                        "choose a result folder where you may write (--output)"));
  }
  return ResultFolder(std::move(target), folder);
}

ResultFolder::ResultFolder(ResultFolder&& other) noexcept
    : target_(std::move(other.target_)), folder_(std::move(other.folder_)), scratch_(std::move(other.scratch_)) {
  other.folder_.clear();
}

ResultFolder::~ResultFolder() {
  std::error_code code;
  if (!folder_.empty()) fs::remove_all(folder_, code);
}

Expected<void> ResultFolder::commit() {
  std::error_code code;
  for (const fs::path& path : scratch_) fs::remove_all(path, code);
  code.clear();
  flush_to_disk(folder_);
  if (fs::exists(target_, code)) {
    if (!exchange_names(folder_, target_)) {
      const fs::path aside = sibling(target_, "old");
      fs::rename(target_, aside, code);
      if (!code) fs::rename(folder_, target_, code);
      if (!code) fs::remove_all(aside, code);
      if (code) return fail(trouble(target_, code.message(), "check the folder's permissions and free space"));
      folder_.clear();
      return {};
    }
    fs::remove_all(folder_, code);  // the old result, which has the sibling's name now
  } else {
    fs::rename(folder_, target_, code);
    if (code) return fail(trouble(target_, code.message(), "check the folder's permissions and free space"));
  }
  folder_.clear();

  return {};
}

}  // namespace versine::io
