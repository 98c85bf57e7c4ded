// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "versine/core/error.hpp"

namespace versine::design {

/// From here on the mileage counts from `mileage`: a chainage equation, or the start of the line.
struct ChainageEquation {
  double distance = 0.0;   ///< along the axis, m
  double mileage = 0.0;    ///< just behind that place, m
  bool increasing = true;  ///< mileage grows with distance
  std::string name;
};

/// Mileage (as the railway counts it, m) against distance along the axis (m). Where a line was rebuilt, mileage jumps:
/// it may leave numbers out, or give one number to two places. Immutable.
class Chainage {
 public:
  /// Equations in order of distance. Empty: mileage equals distance.
  [[nodiscard]] static Expected<Chainage> from_equations(std::vector<ChainageEquation> equations);
  /// Mileage = distance + offset.
  [[nodiscard]] static Chainage offset(double mileage_at_start);
  Chainage() = default;

  [[nodiscard]] const std::vector<ChainageEquation>& equations() const { return equations_; }
  [[nodiscard]] double mileage(double distance) const;
  /// Every distance that carries this mileage, in order: none inside a jump forward, two where numbers repeat.
  /// The first stretch begins at 0, the last ends at `length` (the axis's); each takes 1 mm more for rounding.
  [[nodiscard]] std::vector<double> distances(double mileage, double length) const;
  /// The one of them nearest to `hint`; fails with the stretches' ranges when there is none.
  [[nodiscard]] Expected<double> distance(double mileage, double length, std::optional<double> hint = {}) const;
  /// How much mileage jumps at an equation against going on as before, m (0 for the first).
  [[nodiscard]] double jump(std::size_t equation) const;

 private:
  std::vector<ChainageEquation> equations_;
};

/// "12+345.678": kilometres and metres.
[[nodiscard]] std::string format_mileage(double mileage);

}  // namespace versine::design
