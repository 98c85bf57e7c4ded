// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <filesystem>

#include "versine/track/fastenings.hpp"
#include "versine/track/geometry.hpp"

namespace versine::io {

/// Plans of both rails at the fastenings that `at` is sampled at.
struct FasteningPlans {
  track::Geometry at;
  std::array<track::FasteningPlan, 2> lateral, vertical;  ///< left, right; empty where there is no deviation
};

/// A row for each fastening: measured, movement and what is left, of both rails.
[[nodiscard]] Expected<void> write_fastenings_csv(const std::filesystem::path& path, const FasteningPlans& plans);
/// How many fastenings move by how much: the parts to bring.
[[nodiscard]] Expected<void> write_parts_csv(const std::filesystem::path& path, const FasteningPlans& plans,
                                             double lateral_step, double vertical_step);

}  // namespace versine::io
