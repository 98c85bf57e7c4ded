// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace versine {

/// The candidate with the smallest edit distance to `word` (a transposition counts one), when that is at most a third
/// of its length and at most 3; empty otherwise. For "unknown key 'rtae_hz', did you mean 'rate_hz'?".
[[nodiscard]] std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace versine
