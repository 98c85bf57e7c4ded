// SPDX-License-Identifier: Apache-2.0
#include "versine/app/withhold.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "versine/geodesy/ellipsoid.hpp"

namespace versine::app {

Series<sensors::GnssSample> withhold(Series<sensors::GnssSample>& gnss, const SurveyConfig::Withhold& windows) {
  Series<sensors::GnssSample> hidden{.scale = gnss.scale};
  if (gnss.empty()) return hidden;
  const double every = windows.every > 0.0 ? windows.every : 3.0 * windows.window;
  const Time first = gnss.front().time;
  const Time last = gnss.back().time;
  const auto inside = [&](const sensors::GnssSample& s) {
    const double since = (s.time - first).seconds() - windows.start;
    if (since < 0.0) return false;
    const double begin = every * std::floor(since / every);
    // A window that is cut off by the end of the recording would be an extrapolation, not an outage.
    if (begin + windows.start + windows.window > (last - first).seconds() - 1.0) return false;
    return since - begin < windows.window;
  };
  std::copy_if(gnss.begin(), gnss.end(), std::back_inserter(hidden.samples), inside);
  std::erase_if(gnss.samples, inside);
  return hidden;
}

WithheldErrors compare_withheld(const Series<sensors::GnssSample>& hidden, const geodesy::Trajectory& solution,
                                const Eigen::Vector3d& lever_arm_b) {
  std::vector<double> horizontal;
  double sum_h = 0.0, sum_v = 0.0;
  std::size_t covered = 0;
  WithheldErrors out;
  std::optional<Time> previous;
  for (const sensors::GnssSample& s : hidden) {
    const std::size_t i = solution.lower_bound(s.time);
    if (i == 0 || i >= solution.size() || solution[i].segment != solution[i - 1].segment) continue;
    const auto &a = solution[i - 1], &b = solution[i];
    if (b.time - a.time > Duration::from_seconds(1.0)) continue;
    const double f = (s.time - a.time).seconds() / (b.time - a.time).seconds();
    const Eigen::Vector3d moved = f * geodesy::wgs84.ned_difference(a.position, b.position);
    const Eigen::Vector3d antenna = moved + a.q_nb.slerp(f, b.q_nb) * lever_arm_b;
    const Eigen::Vector3d error = antenna - geodesy::wgs84.ned_difference(a.position, s.position);
    const Eigen::Matrix3d P = (f < 0.5 ? a : b).position_covariance.matrix();
    horizontal.push_back(error.head<2>().norm());
    sum_h += error.head<2>().squaredNorm();
    sum_v += error.z() * error.z();
    for (int k = 0; k < 2; ++k) {
      if (std::abs(error(k)) <= 1.96 * std::sqrt(P(k, k) + s.sigma_ned(k) * s.sigma_ned(k))) ++covered;
    }
    if (!previous || s.time - *previous > Duration::from_seconds(2.0)) ++out.windows;
    previous = s.time;
  }
  out.count = horizontal.size();
  if (out.count == 0) return out;
  const auto n = static_cast<double>(out.count);
  std::sort(horizontal.begin(), horizontal.end());
  out.rms_horizontal = std::sqrt(sum_h / n);
  out.rms_vertical = std::sqrt(sum_v / n);
  out.p95_horizontal = horizontal[static_cast<std::size_t>(0.95 * (n - 1.0))];
  out.max_horizontal = horizontal.back();
  out.coverage = static_cast<double>(covered) / (2.0 * n);
  return out;
}

}  // namespace versine::app
