// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>

#include "versine/io/recording_description.hpp"
#include "versine/io/total_station_formats.hpp"

namespace versine::io {

/// Raw readings: CSV (docs/formats/total-station.md) or a field book, told apart by the content. The CSV's times come
/// in the scale of `file.clock`.
[[nodiscard]] Expected<FieldBook> read_total_station(const TableFile& file);

/// CSV as `read_total_station` reads it, angles in gon to 1e-7 gon, distances to 1 um.
[[nodiscard]] Expected<void> write_total_station(const std::filesystem::path& path,
                                                 std::span<const stationing::Stationing> stationings);

}  // namespace versine::io
