// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "joint_snooping.hpp"

namespace versine::stationing {

/// What the trolley's accelerometers felt at each station, in the instrument's axes. How these lie to the
/// accelerometers' is found from the stations that left nothing out, so a bias and the mounting need not be known.
/// Empty where nothing was felt, and everywhere when fewer than three such stations tell.
[[nodiscard]] std::vector<std::optional<Plumb>> felt_plumb_lines(std::span<const SolvedStation> stations);

}  // namespace versine::stationing
