// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <optional>

#include "versine/batch/outcome.hpp"

namespace versine::batch {

/// What worker processes share: who takes the next of `count` items, and how many are done.
struct WorkQueue {
  std::function<std::optional<std::size_t>()> next;
  std::function<void()> done;
};

/// Runs `worker` in `processes` processes (in this one where that is 1), each handing out items 0 ... count-1 once.
/// Processes instead of threads: HDF5 and GDAL are not made for threads, and a crash takes one unit with it, not the
/// run. `watch` is called five times a second with the number of items done; when it returns false the workers are
/// asked to stop by SIGTERM. Returns the gravest exit; a worker that was killed counts as `again`.
/// REQUIRES that the caller has one thread.
[[nodiscard]] Exit run_processes(int processes, std::size_t count, const std::function<Exit(const WorkQueue&)>& worker,
                                 const std::function<bool(std::size_t)>& watch);

}  // namespace versine::batch
