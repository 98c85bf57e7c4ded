// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace versine::io {

/// Fields of a line, without blanks around them and without quotes; `delimiter` ' ' means any run of blanks and tabs.
/// A delimiter at the very end adds no field.
[[nodiscard]] std::vector<std::string> split_fields(std::string_view line, char delimiter);

}  // namespace versine::io
