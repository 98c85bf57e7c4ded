// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "versine/app/view_series.hpp"
#include "versine/core/error.hpp"
#include "versine/geodesy/projection.hpp"

namespace versine::app {

/// What the strips and the map show of one journey: positions.csv on its grid, fixes.csv at the fixes.
class JourneySeries {
 public:
  struct Column {
    std::vector<double> value, sigma;
  };
  /// Times are s since the journey began, distances m on path 1; both increase or stay.
  struct Table {
    std::vector<double> time, distance;
    std::map<std::string, Column> columns;
  };
  JourneySeries(Table positions, Table fixes, std::string fix_points);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// "t:speed", "d:speed": over time, or over distance; nothing when there is no such quantity.
  [[nodiscard]] std::optional<std::string> encode(const std::string& id, double from, double to,
                                                  std::size_t buckets) const;
  /// Fixes on the map by status: used, weak, rejected, for the path only.
  [[nodiscard]] const std::string& fixes() const { return fixes_; }

 private:
  std::size_t size_ = 0;
  std::map<std::string, ViewSeries> series_;
  std::string fixes_;
};

/// By "recording.journey", counted from 1. `begin` tells when each journey begins, s of the recording's clock; its
/// series count from there.
[[nodiscard]] Expected<std::map<std::string, JourneySeries>> read_journey_series(
    const std::filesystem::path& folder, const geodesy::Projection& projection,
    const std::map<std::string, double>& begin);
/// The strips of every journey, in the order in which they are shown.
[[nodiscard]] nlohmann::ordered_json georef_strips();

}  // namespace versine::app
