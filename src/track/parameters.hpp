// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "relative_sigma.hpp"
#include "versine/track/geometry.hpp"

/// The stages of compute_geometry: each adds its columns.
namespace versine::track {

/// The design on the grid; empty without design.
struct DesignGrid {
  std::vector<double> easting, northing, heading, curvature, height, cant;
  [[nodiscard]] bool empty() const { return easting.empty(); }
  [[nodiscard]] bool has_heights() const { return !empty() && std::isfinite(height.front()); }
  [[nodiscard]] bool has_cant() const { return !empty() && std::isfinite(cant.front()); }
};

/// Everything that the stages share.
struct Stage {
  const GeometryInput& input;
  const GeometryOptions& options;
  const RunMileage& run;
  const RailGrid& rails;
  const DesignGrid& design;
  RelativeSigma& relative;
  Geometry& out;
};

void add_coordinates(Stage& s);
void add_curvature_and_gradient(Stage& s);
void add_gauge_cross_level_twist(Stage& s);
void add_deviations(Stage& s);
void add_bands(Stage& s);
void add_versines(Stage& s);
void add_checks(Stage& s);

/// Sigma of a rail's point laterally and vertically at each grid point, m: position and attitude of the trolley's
/// pose, calibration, contact.
struct PointSigma {
  std::vector<float> lateral, vertical;
};
[[nodiscard]] PointSigma point_sigma(const Stage& s, Rail rail);

inline const char* name_of(Rail rail) {
  return rail == Rail::left ? "left" : "right";
}
inline const RailLine& line_of(const RailGrid& grid, Rail rail) {
  return rail == Rail::left ? grid.left : grid.right;
}
/// The rail has no measured lateral place where the gauge is missing, unless it is the reference rail.
inline bool placed(const RailGrid& grid, Rail rail, std::size_t i) {
  return (grid.flags[i] & no_gauge) == 0 || (rail == Rail::left) == grid.reference_is_left;
}
/// Distance as a part of a column's name: "3m", "2.5m".
[[nodiscard]] std::string metres(double x);

}  // namespace versine::track
