// SPDX-License-Identifier: Apache-2.0
#include "versine/core/error.hpp"

#include <fmt/format.h>

namespace versine {

std::string Error::message() const {
  std::string text;
  if (!file.empty()) text += line > 0 ? fmt::format("{}:{}: ", file, line) : file + ": ";
  if (!field.empty()) text += field + ": ";
  if (!found.empty()) text += "found " + found;
  if (!expected.empty()) text += (found.empty() ? "expected " : ", expected ") + expected;
  if (!advice.empty()) text += "\n  " + advice;
  return text;
}

}  // namespace versine
