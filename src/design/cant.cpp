// SPDX-License-Identifier: Apache-2.0
#include "versine/design/cant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace versine::design {

Expected<CantProfile> CantProfile::from_points(std::vector<CantPoint> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool finite = std::isfinite(points[i].distance) && std::isfinite(points[i].cant);
    if (finite && (i == 0 || points[i].distance >= points[i - 1].distance)) continue;
    return fail({.field = fmt::format("cant point {}", i + 1),
                 .found = fmt::format("distance {} m, cant {} m", points[i].distance, points[i].cant),
                 .expected = finite ? "a distance that does not decrease" : "finite numbers",
                 .advice = "mend the cant in the design"});
  }
  CantProfile profile;
  profile.points_ = std::move(points);
  return profile;
}

CantPose CantProfile::at(double distance) const {
  if (points_.empty()) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan};
  }
  const auto after = std::upper_bound(points_.begin(), points_.end(), distance,
                                      [](double d, const CantPoint& p) { return d < p.distance; });
  if (after == points_.begin()) return {points_.front().cant, 0.0};
  if (after == points_.end()) return {points_.back().cant, 0.0};
  const CantPoint &a = *(after - 1), &b = *after;
  const double length = b.distance - a.distance, change = b.cant - a.cant;
  const Shape shape = is_transition(a.ramp) ? a.ramp : Shape::clothoid;
  const double xi = (distance - a.distance) / length;
  return {a.cant + change * ramp(shape, xi), change / length * ramp_rate(shape, xi)};
}

}  // namespace versine::design
