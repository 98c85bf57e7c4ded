// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "versine/app/recording_config.hpp"
#include "versine/design/optimal_axis.hpp"
#include "versine/io/adjustment_csv.hpp"
#include "versine/track/adjustment.hpp"
#include "versine/track/compute.hpp"
#include "versine/track/fastenings.hpp"
#include "versine/track/limits.hpp"

/// The `[geometry]` table of survey and geometry jobs, and the file of limits.
namespace versine::app {

/// From the map to the project's own grid and heights.
struct CoordinatesConfig {
  enum class Model { none, plane, space };
  enum class Heights { none, offset, plane, geoid };
  FileConfig<io::TableFile> points;
  Model model = Model::none;
  Heights heights = Heights::none;
  bool fixed_scale = false;
  std::string geoid;
};

/// Fine adjustment of a slab track at its fastenings; ranges of a WJ-8 fastening.
struct FasteningConfig {
  enum class Reference { left, right };
  bool on = false;
  double spacing = 0.65;  ///< where no sleepers were detected, m
  Reference reference = Reference::left;
  track::FasteningOptions lateral;
  track::FasteningOptions vertical{.lowest = -4e-3, .highest = 26e-3, .difference_limit = 2e-3};
};

struct GeometryConfig {
  bool present = false;  ///< the job has the table
  track::GeometryOptions options;
  track::Trolley trolley;

  InputPath design, gradients, stationing;
  std::string design_name;
  std::string crs;  ///< of the result; must be the design's
  CoordinatesConfig coordinates;
  double height_offset = 0.0;
  std::string height_datum = "ellipsoidal";
  double error_correlation = 0.0;  ///< m, of a trajectory that comes without joint errors
  bool fit_axis = false;           ///< without design: an optimal axis takes its place
  design::OptimalAxisOptions axis;

  GaugeFileConfig gauge;
  RangeFileConfig sleeper;
  struct Mark {
    double time_s = 0.0, mileage = 0.0;
  };
  std::vector<Mark> marks;

  InputPath limits;
  double speed = 160.0 / 3.6;  ///< of the line, m/s

  bool adjust = false;
  track::AdjustmentOptions slew, lift{.smallest = 0.0, .largest = 0.06};
  io::AdjustmentTable table;
  FasteningConfig fastenings;

  bool csv = true, gpkg = true, xlsx = true, dxf = false;
  double gis_interval = 1.0, xlsx_interval = 5.0;  ///< m
};
void describe(ConfigVisitor& v, GeometryConfig& c);

void describe(ConfigVisitor& v, track::LimitProfile& profile);
/// A file of limits (data/limits/*.toml).
[[nodiscard]] Expected<track::LimitProfile> read_limits(const std::filesystem::path& path);

}  // namespace versine::app
