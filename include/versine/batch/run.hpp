// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "versine/batch/manifest.hpp"
#include "versine/batch/receipt.hpp"

namespace versine::batch {

struct Shard {
  int index = 0, count = 1;
};
struct Selection {
  std::optional<Shard> shard;  ///< none: all units
  bool missing = false;        ///< what has no receipt now, split among `count` by the unit's hash
};
/// Units to be done, the longest first. Those with a receipt are left out. Fails (64) when a shard is named that the
/// manifest does not have.
[[nodiscard]] Outcome<std::vector<std::size_t>> select_units(const Store& store, const Manifest& manifest,
                                                             const Selection& selection);

/// What the stage made of a unit.
struct Made {
  struct File {
    std::string name, bytes;
  };
  std::vector<File> files;
  std::optional<Error> rejection;  ///< the data are bad
};
/// A pure function of the unit's inputs. A Failure leaves the unit open.
using Stage = std::function<Outcome<Made>(const Unit&)>;

/// How one unit ended.
struct Done {
  std::size_t unit = 0;
  enum class State { done, rejected, duplicate, skipped, failed } state = State::done;
  double seconds = 0.0;
  std::optional<Failure> failure;
};
[[nodiscard]] const char* to_string(Done::State state);

/// Does the units that `next` hands out until there are none, `cancelled` says so, or one fails in a way that others
/// would too (75, 78). Each is committed before the next begins. `told` hears of each.
[[nodiscard]] Exit run_units(const Store& store, const Manifest& manifest, const Stage& stage,
                             const std::function<std::optional<std::size_t>()>& next,
                             const std::function<bool()>& cancelled, const std::function<void(const Done&)>& told);

/// 75, or 1 where this was the fifth attempt.
[[nodiscard]] Exit after_attempts(Exit exit, int attempt);

}  // namespace versine::batch
