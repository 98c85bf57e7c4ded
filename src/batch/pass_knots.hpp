// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "versine/batch/journey_entry.hpp"

namespace versine::batch {

/// Knots as the catalogue keeps them: 20 bytes each, little endian: int64 time in ns, int32 distance in mm, int32 speed
/// in mm/s, int32 sigma in mm.
[[nodiscard]] std::string pack_knots(const std::vector<Knot>& knots);
[[nodiscard]] std::vector<Knot> unpack_knots(std::string_view bytes);

}  // namespace versine::batch
