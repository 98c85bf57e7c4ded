// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/spline.hpp"

#include <cmath>

namespace versine::simulation {

QuinticWeights quintic_weights(double u) {
  const double v = 1.0 - u, u2 = u * u, u3 = u2 * u, u4 = u2 * u2, u5 = u4 * u;
  const double v2 = v * v, v3 = v2 * v, v4 = v2 * v2, v5 = v4 * v;
  constexpr double k0 = 1.0 / 120.0, k1 = 1.0 / 24.0, k2 = 1.0 / 6.0;
  QuinticWeights w;
  w.value = {k0 * v5,
             k0 * (26.0 - 50.0 * u + 20.0 * u2 + 20.0 * u3 - 20.0 * u4 + 5.0 * u5),
             k0 * (66.0 - 60.0 * u2 + 30.0 * u4 - 10.0 * u5),
             k0 * (26.0 + 50.0 * u + 20.0 * u2 - 20.0 * u3 - 20.0 * u4 + 10.0 * u5),
             k0 * (1.0 + 5.0 * u + 10.0 * u2 + 10.0 * u3 + 5.0 * u4 - 5.0 * u5),
             k0 * u5};
  w.first = {-k1 * v4,
             k1 * (-10.0 + 8.0 * u + 12.0 * u2 - 16.0 * u3 + 5.0 * u4),
             k1 * (-24.0 * u + 24.0 * u3 - 10.0 * u4),
             k1 * (10.0 + 8.0 * u - 12.0 * u2 - 16.0 * u3 + 10.0 * u4),
             k1 * (1.0 + 4.0 * u + 6.0 * u2 + 4.0 * u3 - 5.0 * u4),
             k1 * u4};
  w.second = {k2 * v3,
              k2 * (2.0 + 6.0 * u - 12.0 * u2 + 5.0 * u3),
              k2 * (-6.0 + 18.0 * u2 - 10.0 * u3),
              k2 * (2.0 - 6.0 * u - 12.0 * u2 + 10.0 * u3),
              k2 * (1.0 + 3.0 * u + 3.0 * u2 - 5.0 * u3),
              k2 * u3};
  return w;
}

void quintic_prefilter(double* samples, std::size_t count, std::size_t stride) {
  const auto at = [&](std::size_t i) -> double& { return samples[i * stride]; };
  // Roots of z^4 + 26 z^3 + 66 z^2 + 26 z + 1 inside the unit circle.
  for (const double z : {-0.43057534709997379, -0.043096288203264654}) {
    const double gain = (1.0 - z) * (1.0 - 1.0 / z);
    for (std::size_t i = 0; i < count; ++i) at(i) *= gain;
    double start = at(0), power = z;
    for (std::size_t i = 1; i < std::min<std::size_t>(count, 64); ++i, power *= z) start += power * at(i);
    at(0) = start;
    for (std::size_t i = 1; i < count; ++i) at(i) += z * at(i - 1);
    at(count - 1) = z / (z * z - 1.0) * (at(count - 1) + z * at(count - 2));
    for (std::size_t i = count - 1; i-- > 0;) at(i) = z * (at(i + 1) - at(i));
  }
}

}  // namespace versine::simulation
