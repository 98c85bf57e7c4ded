// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <versine/fusion/solution.hpp>
#include <versine/geodesy/projection.hpp>

int main() {
  const auto utm = versine::geodesy::Projection::create("EPSG:25832");
  if (!utm) return 1;
  const auto p = utm->forward({0.89, 0.16, 100.0});
  const versine::fusion::Solution solution;
  std::printf("%.3f %.3f %zu\n", p.easting, p.northing, solution.smoothed.size());
  return p.easting > 0.0 ? 0 : 1;
}
