// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/track/adjustment.hpp"
#include "versine/track/geometry.hpp"

namespace versine::io {

/// A table for tamping machines and adjustment crews. Proprietary formats are not public, so columns, their order and
/// signs are the user's, and the head of the file states them.
struct AdjustmentTable {
  /// Of: mileage_m, mileage_km, distance_m, slew_mm, lift_mm, cant_mm, cross_level_mm, reference_rail, easting_m,
  /// northing_m, height_m, slew_left_over_mm (deviation left after the work), lift_left_over_mm.
  std::vector<std::string> columns = {"mileage_m", "slew_mm", "lift_mm", "cant_mm", "reference_rail"};
  bool slew_right_positive = true;
  double interval = 2.5;  ///< m
  std::string delimiter = ",";
  bool decimal_comma = false;
};

/// `cant_mm` is the design cant where there is a design (cross level minus its deviation), else the cross level.
/// The reference rail is the lower one; left in straights. Fails on an unknown column, naming those that exist.
[[nodiscard]] Expected<void> write_adjustment_csv(const std::filesystem::path& path, const track::Geometry& geometry,
                                                  const track::Adjustment* slew, const track::Adjustment* lift,
                                                  const AdjustmentTable& table = {});

}  // namespace versine::io
