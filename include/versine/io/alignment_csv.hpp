// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "versine/core/error.hpp"
#include "versine/design/alignment.hpp"

namespace versine::io {

/// The elements of a design as a table for people and reports: a row per horizontal element (`part` horizontal), then
/// per element of the profile (vertical). Distances along the axis and as posted; radii in metres, positive in a
/// right-hand curve, empty when straight; cants at both ends; gradients in permille, positive uphill.
[[nodiscard]] Expected<void> write_alignment_csv(const std::filesystem::path& path, const design::Alignment& alignment);

}  // namespace versine::io
