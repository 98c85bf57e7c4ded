// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>

namespace versine {

/// How many threads `wanted` means: 0 is every core of the machine.
[[nodiscard]] std::size_t thread_count(int wanted);

/// Calls `work(0)` to `work(count - 1)`, each once, on up to `threads` threads, the caller's among them; returns when
/// all are done. What a call throws is thrown again here, after the others.
void parallel_for(std::size_t count, std::size_t threads, const std::function<void(std::size_t)>& work);

}  // namespace versine
