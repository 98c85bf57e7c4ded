// SPDX-License-Identifier: Apache-2.0
#include "versine/track/correlated_errors.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "versine/geodesy/ellipsoid.hpp"

namespace versine::track {

filter::ErrorChain correlated_errors(const geodesy::Trajectory& trajectory, double length) {
  if (!(length > 0.0) || trajectory.empty()) throw std::invalid_argument("correlated_errors: no length or trajectory");
  // Epochs about a metre apart: nothing is asked for more closely.
  const double spacing = std::min(1.0, 0.02 * length);
  std::vector<std::size_t> epochs = {0};
  std::vector<double> way;
  double gone = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    gone += geodesy::wgs84.ned_difference(trajectory[i - 1].position, trajectory[i].position).norm();
    if (gone < spacing && i + 1 < trajectory.size()) continue;
    epochs.push_back(i);
    way.push_back(gone);
    gone = 0.0;
  }
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  const auto covariance = [&](std::size_t k) {
    Matrix6 P = Matrix6::Zero();
    P.topLeftCorner<3, 3>() = trajectory[epochs[k]].position_covariance.matrix();
    P.bottomRightCorner<3, 3>() = trajectory[epochs[k]].attitude_covariance.matrix();
    return P;
  };
  filter::ErrorChain chain;
  Matrix6 here = covariance(0);
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    Eigen::MatrixXf gain;
    Matrix6 next = here;
    if (k < way.size()) {
      next = covariance(k + 1);
      const Eigen::Array<double, 6, 1> ratio =
          here.diagonal().array().max(0.0).sqrt() / next.diagonal().array().max(1e-24).sqrt();
      gain = (std::exp(-way[k] / length) * ratio).matrix().cast<float>().asDiagonal();
    }
    chain.push_back(trajectory[epochs[k]].time, here.cast<float>(), std::move(gain));
    here = next;
  }
  return chain;
}

}  // namespace versine::track
