// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/core/time.hpp"
#include "versine/geodesy/geodetic.hpp"

/// What is in a file that somebody was handed: for `versine info`.
namespace versine::app {

/// A column of a table, its numbers in the file's own unit.
struct ColumnInfo {
  std::string name;      ///< in the file
  std::string versines;  ///< Versine's name with unit, as far as the header tells; empty: needs an entry in [columns]
  std::size_t numbers = 0, missing = 0;
  double min = 0.0, max = 0.0, mean = 0.0;
  std::string example;  ///< first field, for columns that are no numbers
};

struct TimeInfo {
  TimeScale scale = TimeScale::recorder;
  Time from, to;
  Duration interval;     ///< median
  std::size_t gaps = 0;  ///< of more than 1.5 intervals
  Duration longest_gap;
  std::size_t out_of_order = 0;  ///< stamps that do not increase
};

/// A guess from the numbers, with the reason.
struct Guess {
  std::string what, reason;
};

struct RecordingInfo {
  std::filesystem::path path;
  std::string format;  ///< "table, divided by ','", "RTKLIB solution", "NMEA 0183", "trajectory (HDF5)"
  std::size_t samples = 0;
  std::vector<ColumnInfo> columns;
  std::optional<TimeInfo> time;
  std::optional<std::pair<geodesy::Geodetic, geodesy::Geodetic>> box;  ///< south-west-low and north-east-high
  std::vector<std::pair<std::string, std::size_t>> fixes;              ///< type and count
  std::vector<Guess> guesses;
  std::vector<std::string> findings;
};

/// Looks through the whole file.
[[nodiscard]] Expected<RecordingInfo> recording_info(const std::filesystem::path& path);
[[nodiscard]] std::string to_text(const RecordingInfo& info);
[[nodiscard]] std::string to_json(const RecordingInfo& info);

}  // namespace versine::app
