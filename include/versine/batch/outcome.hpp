// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/core/error.hpp"

/// Batches: work units that any engine can run, lose, repeat and run twice without harm. docs/batch.md is the contract.
namespace versine::batch {

/// Exit codes of `versine batch`, the same for every engine.
enum class Exit : int {
  done = 0,
  failed = 1,         ///< 75 for the fifth time
  incomplete = 2,     ///< units without a receipt
  rejected = 3,       ///< complete, with units whose data are bad
  usage = 64,         ///< arguments, or a manifest that is not there
  changed = 65,       ///< the manifest, or an input, is not what it was when the manifest was written
  differs = 70,       ///< two executions of a unit gave different results
  again = 75,         ///< no space, input or output error, SIGTERM: the same command will go on
  configuration = 78  ///< the manifest was written for another engine or configuration
};

/// Why a command or a unit did not succeed, and what an engine should do about it.
struct Failure {
  Exit exit = Exit::again;
  Error error;
};
template <class T>
using Outcome = tl::expected<T, Failure>;

inline tl::unexpected<Failure> failure(Exit exit, Error error) {
  return tl::unexpected<Failure>(Failure{exit, std::move(error)});
}
/// Of two exits the one that an engine must see first.
[[nodiscard]] Exit graver(Exit a, Exit b);

}  // namespace versine::batch
