// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "versine/track/joint_errors.hpp"
#include "versine/track/rails.hpp"

namespace versine::track {

/// What a number depends on.
enum class Direction { lateral, vertical, roll };

/// Sigmas of numbers formed from places apart along the track (versines, chord checks, twist, gradient), from the
/// trajectory's joint errors at nodes every few metres and the white noise of wheel against rail.
class RelativeSigma {
 public:
  RelativeSigma(const GeometryInput& input, const GeometryOptions& options, const RunMileage& run,
                const RailGrid& grid);

  [[nodiscard]] bool known() const { return joint_ != nullptr; }
  /// `terms`: distance from the point (m) and weight. `white`: sigma of one point, m. `factor` scales the result.
  /// Fills `column.sigma` where it has values; leaves NaN without a chain.
  void fill(Column& column, Rail rail, Direction direction, const std::vector<std::pair<double, double>>& terms,
            double white, double factor = 1.0);
  /// Sigmas of what a filter leaves of both rails' deviations, in four columns: left lateral, left vertical, right
  /// lateral, right vertical. `response`: the filter's impulse response on the grid, symmetric; `white` per column.
  void fill_filtered(const std::array<Column*, 4>& columns, const std::vector<double>& response,
                     const std::array<double, 4>& white);

 private:
  void put(Column& column, std::vector<double> variance, double white_variance, double factor) const;
  static constexpr double spacing = 5.0;  ///< of the nodes, m: errors of a smoothed trajectory bend over tens of metres
  std::size_t stride_ = 1;                ///< grid points per node
  double node_step_ = spacing;
  std::unique_ptr<JointErrors> joint_;
  std::array<std::vector<ErrorRow>, 5> rows_;  ///< left lateral, left vertical, right lateral, right vertical, roll
};

}  // namespace versine::track
