// SPDX-License-Identifier: Apache-2.0
#include "felt_up.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "versine/core/numbers.hpp"

namespace versine::stationing {
namespace {

constexpr std::size_t least_stations = 3;
constexpr double plausible = 3.0;  ///< sigmas, of the median station; beyond it a station's weight falls

/// Up as one station knows it twice.
struct UpTwice {
  Eigen::Vector3d felt, own;  ///< in the accelerometers' axes; in the instrument's, by its own targets
  double sigma;               ///< of their difference, rad
  double weight = 1.0;
};

/// The rotation that brings what is felt closest to what the targets tell (Wahba's problem). Directions all alike leave
/// the turn about them open, and then it makes no difference.
Eigen::Matrix3d rotation_of(std::span<const UpTwice> pairs) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const UpTwice& p : pairs) sum += p.weight / square(p.sigma) * p.own * p.felt.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixU() * Eigen::Vector3d(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
}

/// Stations with a wrong target disagree, so the weights follow the agreement (Cauchy).
std::optional<Eigen::Matrix3d> robust_rotation(std::vector<UpTwice> pairs) {
  Eigen::Matrix3d R_sb;
  std::vector<double> differences(pairs.size());
  for (int round = 0; round < 10; ++round) {
    R_sb = rotation_of(pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      differences[i] = (R_sb * pairs[i].felt - pairs[i].own).norm() / pairs[i].sigma;
      pairs[i].weight = 1.0 / (1.0 + square(differences[i] / plausible));
    }
  }
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  // Otherwise the circle was turned between the stations, or the trolley moved.
  return *middle < plausible ? std::optional(R_sb) : std::nullopt;
}

}  // namespace

std::vector<std::optional<Plumb>> felt_plumb_lines(std::span<const SolvedStation> stations) {
  std::vector<std::optional<Plumb>> lines(stations.size());
  std::vector<UpTwice> pairs;
  for (const SolvedStation& s : stations) {
    const auto& felt = s.readings->felt_up;
    if (!felt) continue;
    const double attitude = s.result->covariance.diagonal().segment<3>(3).maxCoeff();
    pairs.push_back(
        {felt->up, s.result->q_ms.conjugate() * up_at(s.result->position), std::sqrt(attitude + square(felt->sigma))});
  }
  if (pairs.size() < least_stations) return lines;
  const auto R_sb = robust_rotation(std::move(pairs));
  for (std::size_t i = 0; R_sb && i < stations.size(); ++i) {
    if (const auto& f = stations[i].readings->felt_up) lines[i] = Plumb{(*R_sb * f->up).normalized(), f->sigma};
  }
  return lines;
}

}  // namespace versine::stationing
