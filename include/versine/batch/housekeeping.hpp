// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "versine/batch/manifest.hpp"

namespace versine::batch {

struct ShardStatus {
  std::size_t done = 0, rejected = 0, open = 0;
};
struct Status {
  std::vector<ShardStatus> shards;
  std::size_t done = 0, rejected = 0, open = 0;
  std::size_t damaged = 0;        ///< receipts that cannot be read; counted as open
  double units_per_second = 0.0;  ///< from the log; 0: not known
  double seconds_left = 0.0;      ///< by weight at the log's rate; 0: not known
  [[nodiscard]] Exit exit() const { return open > 0 ? Exit::incomplete : rejected > 0 ? Exit::rejected : Exit::done; }
};
[[nodiscard]] Outcome<Status> status(const Store& store, const Manifest& manifest);

/// One line of the manifest's log, advisory: when (s since 1970), where, what, how long.
void write_log(const Store& store, const std::string& manifest, const std::string& unit, const std::string& state,
               double seconds);

struct Verification {
  std::size_t receipts = 0, objects = 0;  ///< looked at
  std::vector<Error> withdrawn;           ///< one a receipt that was taken back, or an object that was removed
};
/// Reads every receipt of the store and re-hashes every object. A receipt that is damaged, or that names an object
/// that is missing or damaged, is withdrawn, so that the unit is open again; a damaged object is removed.
[[nodiscard]] Outcome<Verification> verify(const Store& store);

struct Collected {
  std::size_t tmp = 0, objects = 0;
  std::uintmax_t bytes = 0;
};
/// Removes files in tmp/, and objects that no receipt names, not touched for `older` seconds.
[[nodiscard]] Outcome<Collected> collect_garbage(const Store& store, double older);

}  // namespace versine::batch
