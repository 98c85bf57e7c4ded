// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <map>
#include <optional>

#include "versine/core/error.hpp"
#include "versine/stationing/reduction.hpp"

/// A station's readings sorted by set and point, and its two faces made one.
namespace versine::stationing {

/// One target in one set.
struct Pointing {
  std::optional<Sighting> one, two;
  /// As face I; NaN until the faces are merged.
  double direction = std::numeric_limits<double>::quiet_NaN(), zenith = std::numeric_limits<double>::quiet_NaN(),
         distance = std::numeric_limits<double>::quiet_NaN();
  bool both() const { return one && two; }
};
using Set = std::map<std::size_t, Pointing>;  // by index of the point

struct Grouped {
  std::vector<std::string> points;
  std::vector<std::size_t> line;
  std::vector<double> target_height;
  std::map<int, Set> sets;
};

/// Sorts readings by set and point. Unnamed targets are told apart by where they point. Fails on values that are none.
Expected<Grouped> group_readings(const Stationing& s);

/// Two faces sum to a full circle; in a wrong unit they sum to 0.9 or 1.11 of it.
Expected<void> check_unit(const Stationing& s, const Grouped& g);

/// Collimation and index error as each pointing in both faces shows them, rad.
struct AxisErrors {
  std::vector<double> collimation, index;
};

AxisErrors axis_errors(const Grouped& g);

/// Each pointing as it would be in face I without axis errors, distances corrected for air, scale and prism.
void merge_faces(const Stationing& s, const Instrument& instrument, double collimation, double index, Grouped& g);

/// NaN for nothing.
double median(std::vector<double> v);

}  // namespace versine::stationing
