// SPDX-License-Identifier: Apache-2.0
#include "versine/gnss/fixed_sigma.hpp"

#include <algorithm>

namespace versine::gnss {

Series<sensors::GnssSample> with_steady_sigmas(Series<sensors::GnssSample> series, std::size_t half) {
  std::vector<std::size_t> fixed;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (series[i].fix == sensors::FixType::fixed) fixed.push_back(i);
  }
  std::vector<Eigen::Vector3d> medians(fixed.size());
  std::vector<double> window;
  for (std::size_t k = 0; k < fixed.size(); ++k) {
    const std::size_t from = k > half ? k - half : 0, to = std::min(fixed.size(), k + half + 1);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      window.clear();
      for (std::size_t j = from; j < to; ++j) window.push_back(series[fixed[j]].sigma_ned[axis]);
      const auto middle = window.begin() + static_cast<std::ptrdiff_t>(window.size() / 2);
      std::nth_element(window.begin(), middle, window.end());
      medians[k][axis] = *middle;
    }
  }
  for (std::size_t k = 0; k < fixed.size(); ++k) {
    auto& sigma = series.samples[fixed[k]].sigma_ned;
    sigma = sigma.cwiseMax(medians[k]);
  }
  return series;
}

}  // namespace versine::gnss
