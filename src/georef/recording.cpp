// SPDX-License-Identifier: Apache-2.0
#include "versine/georef/recording.hpp"

#include <cmath>

namespace versine::georef {

Series<Fix> to_fixes(const Series<sensors::GnssSample>& gnss) {
  Series<Fix> out;
  out.scale = gnss.scale;
  out.samples.reserve(gnss.size());
  for (const auto& g : gnss) {
    Fix f{g.time, g.position, std::sqrt(0.5 * g.sigma_ned.head<2>().squaredNorm()), {}, 0.0, g.fix, g.satellites};
    if (g.v_ned) {
      f.speed = g.v_ned->head<2>().norm();
      f.sigma_speed = std::sqrt(0.5 * g.sigma_v_ned.head<2>().squaredNorm());
    }
    out.samples.push_back(f);
  }
  return out;
}

}  // namespace versine::georef
