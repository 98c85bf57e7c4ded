// SPDX-License-Identifier: Apache-2.0
#include "diagnosis.hpp"

#include <Eigen/SVD>
#include <cmath>

#include "statistics.hpp"

namespace versine::stationing {
namespace {

/// The targets as they would be had both angles been read in a unit `factor` times as large.
std::vector<Pair> with_angles_scaled(std::span<const Pair> pairs, double factor) {
  std::vector<Pair> scaled;
  for (const Pair& p : pairs) {
    double r = std::atan2(p.local.y(), p.local.x());
    if (r < 0.0) r += 2.0 * M_PI;  // a reading is counted from 0
    r *= factor;
    const double d = p.local.norm(), z = factor * std::acos(-p.local.z() / d);
    scaled.push_back({{d * std::sin(z) * std::cos(r), d * std::sin(z) * std::sin(r), -d * std::cos(z)}, p.global});
  }
  return scaled;
}

bool on_a_line(std::span<const Pair> pairs) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Pair& p : pairs) mean += p.global / static_cast<double>(pairs.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Pair& p : pairs) spread += (p.global - mean) * (p.global - mean).transpose();
  const auto values = Eigen::JacobiSVD<Eigen::Matrix3d>(spread).singularValues();
  return values(1) < 1e-4 * values(0);
}

}  // namespace

Error diagnose_start(std::span<const Pair> pairs, double tolerance, double largest_tilt, Error error) {
  if (on_a_line(pairs)) {
    error.found = "targets that lie on a line";
    error.expected = "points that span at least a triangle";
    error.advice = "use back-sights on both sides of the track, ahead and behind";
    return error;
  }
  const auto most = [&](const std::vector<Pair>& changed) {
    const auto c = find_consensus(changed, tolerance, largest_tilt, false);
    return c && c->count >= 3 && 4 * c->count >= 3 * changed.size();
  };
  std::vector<Pair> exchanged(pairs.begin(), pairs.end());
  for (Pair& p : exchanged) std::swap(p.global.x(), p.global.y());
  if (most(with_angles_scaled(pairs, 10.0 / 9.0))) {
    error.advice = "they agree when the angles are taken as degrees: name the columns direction_deg and zenith_deg";
  } else if (most(with_angles_scaled(pairs, 0.9))) {
    error.advice = "they agree when the angles are taken as gon: name the columns direction_gon and zenith_gon";
  } else if (most(exchanged)) {
    error.advice = "they agree when easting and northing of the control points are exchanged: correct the columns";
  } else {
    error.advice =
        "are the point numbers right, and is this the control list of this line? Leave the numbers empty to "
        "find the points by their coordinates";
  }
  return error;
}

std::optional<DistanceError> common_distance_error(const std::vector<Observation>& observations, const Adjustment& a) {
  // Score test of one more unknown k in `along = distance - k`: its normal equation after elimination of the others.
  double info = 0.0, score = 0.0;
  Eigen::Matrix<double, 7, 1> coupling = Eigen::Matrix<double, 7, 1>::Zero();
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Eigen::Vector3d column = observations[i].whitening.col(2);
    info += column.squaredNorm();
    score += column.dot(a.whitened[i]);
    coupling += a.jacobian[i].transpose() * column;
  }
  info -= coupling.dot(a.covariance * coupling);
  if (!(info > 0.0)) return {};
  const double k = score / info, sigma = 1.0 / std::sqrt(info);
  const double rest = a.squares - k * k * info;
  const bool bad_without = a.squares > chi_square_quantile(a.redundancy, 1e-4);
  const bool good_with = a.redundancy > 1 && rest < chi_square_quantile(a.redundancy - 1, 1e-3);
  if (!(bad_without && good_with && std::abs(k) > 5.0 * sigma && std::abs(k) > 3e-3)) return {};
  return DistanceError{k, std::sqrt(rest / (a.redundancy - 1))};
}

}  // namespace versine::stationing
