// SPDX-License-Identifier: Apache-2.0
#include "relative_sigma.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace versine::track {

RelativeSigma::RelativeSigma(const GeometryInput& input, const GeometryOptions& options, const RunMileage& run,
                             const RailGrid& grid) {
  if (input.chain == nullptr || input.chain->empty() || grid.mileage.size() < 2) return;
  stride_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(spacing / options.step)));
  node_step_ = double(stride_) * options.step;
  const Trolley& t = input.trolley;
  const Eigen::Matrix3d C_bv = geodesy::to_matrix(t.mounting).transpose();
  const double half = 0.5 * options.rail_distance;
  const Eigen::Vector3d middle = beam_centre(t, options.nominal_gauge);
  std::vector<Time> times;
  for (std::size_t i = 0; i < grid.mileage.size(); i += stride_) {
    times.push_back(grid.time[i]);
    const auto& p = (*input.trajectory)[grid.epoch[i]];
    const Eigen::Matrix3d C = p.q_nb.toRotationMatrix() * C_bv;
    const Eigen::Vector3d forward = run.direction * C.col(0);
    const Eigen::Vector3d right = Eigen::Vector3d(-forward.y(), forward.x(), 0.0).normalized();
    const Eigen::Vector3d up(0.0, 0.0, -1.0);
    for (int rail = 0; rail < 2; ++rail) {
      // With C_hat = (I - phi x) C, a point at C l is off by (C l) x phi: along u by phi . (u x C l).
      const double y = run.direction * (rail == 0 ? -half : half);
      const Eigen::Vector3d l = C * (middle + Eigen::Vector3d(0.0, y, 0.0));
      const Eigen::Vector3d axes[2] = {right, up};
      for (int d = 0; d < 2; ++d) {
        ErrorRow row;
        row << axes[d].cast<float>(), axes[d].cross(l).cast<float>();
        rows_[static_cast<std::size_t>(2 * rail + d)].push_back(row);
      }
    }
    ErrorRow roll = ErrorRow::Zero();
    roll.tail<3>() = (options.rail_distance * forward).cast<float>();
    rows_[4].push_back(roll);
  }
  for (std::size_t k = 1; k < times.size(); ++k) {
    if (times[k] == times[k - 1]) return;  // a gap at the end of the run: no order to rely on
  }
  joint_ = std::make_unique<JointErrors>(*input.chain, times);
}

void RelativeSigma::fill(Column& column, Rail rail, Direction direction,
                         const std::vector<std::pair<double, double>>& terms, double white, double factor) {
  if (!known()) return;
  std::vector<JointErrors::Term> nodes;
  double white_variance = 0.0;
  for (const auto& [distance, weight] : terms) {
    auto node = std::llround(distance / node_step_);
    if (node == 0 && distance != 0.0) node = distance > 0.0 ? 1 : -1;  // never let two places fall together
    nodes.push_back({static_cast<std::ptrdiff_t>(node), weight});
    white_variance += weight * weight * white * white;
  }
  const std::size_t rows =
      direction == Direction::roll ? 4 : (rail == Rail::left ? 0u : 2u) + (direction == Direction::lateral ? 0u : 1u);
  std::vector<double> v = joint_->variance(nodes, rows_[rows]);
  // Near the ends a rounded distance may leave the run by one node: the nearest known value stands in.
  for (std::size_t i = 1; i < v.size(); ++i) {
    if (std::isnan(v[i])) v[i] = v[i - 1];
  }
  for (std::size_t i = v.size(); i-- > 1;) {
    if (std::isnan(v[i - 1])) v[i - 1] = v[i];
  }
  for (std::size_t i = 0; i < column.value.size(); ++i) {
    if (!std::isfinite(column.value[i])) continue;
    const std::size_t k = std::min(i / stride_, v.size() - 1), m = std::min(k + 1, v.size() - 1);
    const double f = double(i - k * stride_) / double(stride_);
    const double chain = v[k] + std::min(1.0, f) * (v[m] - v[k]);
    column.sigma[i] = static_cast<float>(factor * std::sqrt(std::max(0.0, chain) + white_variance));
  }
}

}  // namespace versine::track
