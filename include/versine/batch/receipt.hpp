// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "versine/batch/outcome.hpp"
#include "versine/batch/store.hpp"

namespace versine::batch {

/// What a unit made.
struct Output {
  std::string name;  ///< "summary", "positions"
  std::string sha256;
  std::uintmax_t bytes = 0;
};

/// The only truth about a unit: it is done when its receipt is there. Holds no time, host or path.
struct Receipt {
  std::string unit;
  std::vector<Output> outputs;     ///< of a unit that is done
  std::optional<Error> rejection;  ///< bad data: why; such a unit is never tried again
};

[[nodiscard]] std::string to_text(const Receipt& receipt);
/// Fails when the text is not what `to_text` makes (its own check sum included).
[[nodiscard]] Expected<Receipt> receipt_from(const std::string& text);

enum class Commit { created, duplicate };
/// Links the receipt into its place, if there is none. One with the same bytes there: a duplicate, fine. Other bytes:
/// fails (70).
[[nodiscard]] Outcome<Commit> commit(const Store& store, const Receipt& receipt);
/// The receipt of a unit; nothing when there is none. Fails (75) when it is damaged: `verify` withdraws it.
[[nodiscard]] Outcome<std::optional<Receipt>> find_receipt(const Store& store, const std::string& unit);
[[nodiscard]] bool has_receipt(const Store& store, const std::string& unit);

}  // namespace versine::batch
