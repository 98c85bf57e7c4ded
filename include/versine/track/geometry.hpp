// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "versine/core/run_record.hpp"
#include "versine/core/time.hpp"

namespace versine::track {

/// One quantity along the track. Values are SI inside; `unit` and `scale` say how they are shown and written:
/// shown = value / scale, and the name of a written column is `name + "_" + unit`.
struct Column {
  std::string name;           ///< "gauge", "alignment_left_d1", "deviation_lateral_right", ...
  std::string unit;           ///< "mm", "m", "mm/m", "1/km", "permille", "deg"
  double scale = 1.0;         ///< 1e-3 for "mm"
  std::string description;    ///< meaning, reference, sign, filter: one sentence for a person
  std::vector<double> value;  ///< NaN where there is none
  std::vector<float> sigma;   ///< standard deviation, same unit; NaN where unknown; empty when it has no meaning

  /// "gauge_mm", "twist_3m_mm_per_m": fit for a CSV header or a database.
  [[nodiscard]] std::string heading() const;
};

/// What is particular about a point; bits of Geometry::flags.
enum Flag : std::uint32_t {
  no_gauge = 1u << 0,       ///< the gauge stream is missing: nominal gauge places the axis, the other rail has none
  no_trajectory = 1u << 1,  ///< inside a gap of the trajectory: no value
  off_design = 1u << 2,     ///< outside the design alignment: no deviation
  band_edge = 1u << 3,      ///< within one longest wavelength of an end: the band filters have not settled
  repeated = 1u << 4,       ///< passed more than once (the trolley rolled back); the first pass is used
  few_samples = 1u << 5,    ///< fewer samples than the local fit wants; the value is interpolated
};

/// Piece of continuous mileage with the chainage posted along the line: posted = posted_start + mileage - start.
struct PostedMileage {
  double start = 0.0;         ///< continuous mileage where this piece begins, m
  double posted_start = 0.0;  ///< chainage there, m
  bool increasing = true;     ///< chainage grows with continuous mileage
};

/// A detected or mended sleeper.
struct Sleeper {
  double mileage = 0.0;  ///< continuous, m
  bool mended = false;   ///< the sensor missed it; placed from its neighbours' spacing
};

/// Track geometry by mileage, at a fixed step: the value that quality, adjustment, reports, the viewer and every
/// export read. Columns that could not be formed are absent, never empty.
///
/// Signs, right in the direction of increasing mileage: lateral values are positive to the right, vertical ones
/// upwards; cross level is positive when the left rail is higher; curvature is positive in a right-hand curve.
struct Geometry {
  double step = 0.25;           ///< m
  std::vector<double> mileage;  ///< continuous, m, increasing
  std::vector<Time> time;       ///< when the trolley's beam was there
  TimeScale time_scale = TimeScale::recorder;
  std::vector<std::uint32_t> flags;  ///< sum of Flag
  std::vector<Column> columns;
  std::vector<Sleeper> sleepers;
  std::vector<PostedMileage> posted;  ///< empty: posted and continuous mileage are the same
  std::string crs;                    ///< of easting and northing: PROJ definition
  bool own_grid = false;              ///< coordinates are in a grid of the project's own, tied to `crs` by a similarity
  std::string height_datum;           ///< of heights, in words
  std::string origin;                 ///< what made the trajectory
  /// Sign, side, filter and rail-point conventions, for the head of every export.
  std::vector<std::pair<std::string, std::string>> conventions;
  RunRecord record;

  [[nodiscard]] std::size_t size() const { return mileage.size(); }
  /// nullptr when there is no such column.
  [[nodiscard]] const Column* find(std::string_view name) const;
  [[nodiscard]] Column* find(std::string_view name);
  /// REQUIRES that it exists.
  [[nodiscard]] const Column& at(std::string_view name) const;
  /// Adds an empty column of size() values, NaN throughout, with sigmas when `with_sigma`.
  Column& add(std::string name, std::string unit, double scale, std::string description, bool with_sigma = true);
  /// Chainage as posted along the line at a continuous mileage.
  [[nodiscard]] double posted_at(double continuous) const;
  /// Index of the grid point nearest to a continuous mileage. REQUIRES size() > 0.
  [[nodiscard]] std::size_t index_at(double continuous) const;
};

/// The same quantities at other mileages (sleepers): each column interpolated linearly between the two grid points,
/// the sigma taken as the larger of theirs; flags united. Points outside are left out.
[[nodiscard]] Geometry sampled_at(const Geometry& geometry, const std::vector<double>& mileages);

}  // namespace versine::track
