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
  double white_variance = 0.0, stretch = 1.0;
  for (const auto& [distance, weight] : terms) {
    auto node = std::llround(distance / node_step_);
    if (node == 0 && distance != 0.0) {
      // Never let two places fall together. Errors gather like a random walk over so short a way.
      node = distance > 0.0 ? 1 : -1;
      stretch = std::min(stretch, std::abs(distance) / node_step_);
    }
    nodes.push_back({static_cast<std::ptrdiff_t>(node), weight});
    white_variance += weight * weight * white * white;
  }
  const std::size_t rows =
      direction == Direction::roll ? 4 : (rail == Rail::left ? 0u : 2u) + (direction == Direction::lateral ? 0u : 1u);
  std::vector<double> v = joint_->variance(nodes, rows_[rows]);
  for (double& x : v) x *= stretch;
  put(column, std::move(v), white_variance, factor);
}

void RelativeSigma::fill_filtered(const std::array<Column*, 4>& columns, const std::vector<double>& response,
                                  const std::array<double, 4>& white) {
  if (!known()) return;
  // Errors between two nodes lie on the line between them: each grid weight goes to both by its distance.
  const auto middle = static_cast<std::ptrdiff_t>(response.size() / 2), stride = static_cast<std::ptrdiff_t>(stride_);
  const std::ptrdiff_t reach = middle / stride + 1;
  std::vector<float> weights(static_cast<std::size_t>(2 * reach + 1), 0.0f);
  double squares = 0.0;
  for (std::ptrdiff_t i = -middle; i <= middle; ++i) {
    const double w = response[static_cast<std::size_t>(i + middle)], at = double(i) / double(stride);
    const auto left = static_cast<std::ptrdiff_t>(std::floor(at));
    const double part = at - double(left);
    weights[static_cast<std::size_t>(left + reach)] += static_cast<float>(w * (1.0 - part));
    if (part > 0.0) weights[static_cast<std::size_t>(left + 1 + reach)] += static_cast<float>(w * part);
    squares += w * w;
  }
  const std::array<std::span<const ErrorRow>, 4> rows = {rows_[0], rows_[1], rows_[2], rows_[3]};
  // Sigmas change over hundreds of metres: a fifth of the filter's reach is close enough.
  const auto variance = joint_->filtered_variance(weights, rows, std::max<std::size_t>(1, weights.size() / 10));
  for (std::size_t k = 0; k < 4; ++k) put(*columns[k], variance[k], squares * white[k] * white[k], 1.0);
}

void RelativeSigma::put(Column& column, std::vector<double> v, double white_variance, double factor) const {
  // Known at some nodes: lines between them; outside the first or last one stands in.
  std::size_t last = v.size();
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (std::isnan(v[i])) continue;
    for (std::size_t k = last == v.size() ? 0 : last + 1; k < i; ++k) {
      v[k] = last == v.size() ? v[i] : v[last] + (v[i] - v[last]) * double(k - last) / double(i - last);
    }
    last = i;
  }
  if (last == v.size()) return;
  for (std::size_t k = last + 1; k < v.size(); ++k) v[k] = v[last];
  for (std::size_t i = 0; i < column.value.size(); ++i) {
    if (!std::isfinite(column.value[i])) continue;
    const std::size_t k = std::min(i / stride_, v.size() - 1), m = std::min(k + 1, v.size() - 1);
    const double f = double(i - k * stride_) / double(stride_);
    const double chain = v[k] + std::min(1.0, f) * (v[m] - v[k]);
    column.sigma[i] = static_cast<float>(factor * std::sqrt(std::max(0.0, chain) + white_variance));
  }
}

}  // namespace versine::track
