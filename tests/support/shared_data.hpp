// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "versine/core/process.hpp"

/// Real recordings lie beside the repository, in ../shared/data (or where VERSINE_DATA says), never in it.
namespace versine::test {
inline std::filesystem::path shared_data() {
  if (const char* folder = std::getenv("VERSINE_DATA")) return folder;
  return std::filesystem::path(VERSINE_SOURCE_DIR) / ".." / "shared" / "data";
}
}  // namespace versine::test

/// Skips a test by name when its real data are not there; in CI that is a failure.
#define VERSINE_NEEDS(variable, relative)                                                          \
  const std::filesystem::path variable = ::versine::test::shared_data() / (relative);              \
  if (!std::filesystem::exists(variable)) {                                                        \
    if (std::getenv("CI") != nullptr) FAIL() << variable << " is missing, and CI must have it";    \
    GTEST_SKIP() << variable << " is not here: set VERSINE_DATA to the folder of real recordings"; \
  }

/// The same for a program that a test compares with.
#define VERSINE_NEEDS_PROGRAM(name, package)                                                \
  if (!::versine::find_program(name)) {                                                     \
    if (std::getenv("CI") != nullptr) FAIL() << name << " is missing, and CI must have it"; \
    GTEST_SKIP() << name << " is not installed (Debian: apt install " package ")";          \
  }
