// SPDX-License-Identifier: Apache-2.0
#include "versine/design/chainage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace versine::design {

namespace {
double mileage_on(const ChainageEquation& e, double distance) {
  return e.mileage + (e.increasing ? 1.0 : -1.0) * (distance - e.distance);
}
constexpr double rounding = 1e-3;
}  // namespace

Expected<Chainage> Chainage::from_equations(std::vector<ChainageEquation> equations) {
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const bool finite = std::isfinite(equations[i].distance) && std::isfinite(equations[i].mileage);
    if (finite && (i == 0 || equations[i].distance > equations[i - 1].distance)) continue;
    return fail({.field = fmt::format("chainage equation {}", i + 1),
                 .found = fmt::format("distance {} m, mileage {} m", equations[i].distance, equations[i].mileage),
                 .expected = finite ? "a distance that increases" : "finite numbers",
                 .advice = "mend the stationing in the design"});
  }
  Chainage chainage;
  chainage.equations_ = std::move(equations);
  return chainage;
}

Chainage Chainage::offset(double mileage_at_start) {
  Chainage chainage;
  chainage.equations_.push_back({.distance = 0.0, .mileage = mileage_at_start});
  return chainage;
}

double Chainage::mileage(double distance) const {
  if (equations_.empty()) return distance;
  const auto after = std::upper_bound(equations_.begin() + 1, equations_.end(), distance,
                                      [](double d, const ChainageEquation& e) { return d < e.distance; });
  return mileage_on(*(after - 1), distance);
}

std::vector<double> Chainage::distances(double mileage, double length) const {
  static const std::vector<ChainageEquation> identity(1);
  const auto& equations = equations_.empty() ? identity : equations_;
  std::vector<double> found;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const ChainageEquation& e = equations[i];
    const double from = i == 0 ? 0.0 : e.distance;
    const double to = i + 1 == equations.size() ? length : equations[i + 1].distance;
    const double distance = e.distance + (e.increasing ? 1.0 : -1.0) * (mileage - e.mileage);
    // Two stretches meet: their common place is one place.
    const bool again = !found.empty() && distance - found.back() <= 2.0 * rounding;
    if (distance >= from - rounding && distance <= to + rounding && !again) found.push_back(distance);
  }
  return found;
}

Expected<double> Chainage::distance(double mileage, double length, std::optional<double> hint) const {
  const std::vector<double> all = distances(mileage, length);
  if (all.empty()) {
    return fail({.field = "mileage",
                 .found = format_mileage(mileage),
                 .expected = fmt::format("a mileage of the alignment, which runs from {} to {}{}",
                                         format_mileage(this->mileage(0.0)), format_mileage(this->mileage(length)),
                                         equations_.size() > 1 ? " with jumps" : ""),
                 .advice = "check the mileage, and that it belongs to this line"});
  }
  const double near = hint.value_or(all.front());
  return *std::min_element(all.begin(), all.end(),
                           [near](double a, double b) { return std::abs(a - near) < std::abs(b - near); });
}

double Chainage::jump(std::size_t equation) const {
  if (equation == 0) return 0.0;
  return equations_[equation].mileage - mileage_on(equations_[equation - 1], equations_[equation].distance);
}

std::string format_mileage(double mileage) {
  const double rounded = std::round(std::abs(mileage) * 1000.0) / 1000.0;
  const double km = std::floor(rounded / 1000.0);
  return fmt::format("{}{:.0f}+{:07.3f}", mileage < 0.0 && rounded > 0.0 ? "-" : "", km, rounded - 1000.0 * km);
}

}  // namespace versine::design
