// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "versine/core/time.hpp"

namespace versine {

/// Something an integrity check found in a recording, and what was done about it.
struct Finding {
  enum class Action {
    repaired,  ///< replaced by a value that follows from its neighbours
    removed,   ///< left out
    split,     ///< the run is processed as segments around it
    noted,     ///< kept as it is, to be looked at
  };
  std::string sensor;     ///< "imu", "gnss", "odometer", "gauge", ...
  std::string kind;       ///< "gap", "duplicate time", "spike", "stuck", "out of range", "not a number", ...
  Time from;              ///< first sample concerned
  Time to;                ///< last sample concerned
  std::size_t count = 0;  ///< samples concerned
  Action action = Action::noted;
  std::string detail;     ///< values, for a person
};

/// A measurement that the filter did not use. A rejected measurement is data, not an error.
struct Rejection {
  std::string sensor;
  Time time;
  std::string reason;  ///< "innovation", "sequence", "outside the recording", "not standing", ...
  double normalized = std::numeric_limits<double>::quiet_NaN();  ///< normalised innovation (square root of NIS)
  double threshold = std::numeric_limits<double>::quiet_NaN();
};

/// What happened in a run besides its result; goes into run.json and the report.
struct RunRecord {
  std::vector<Finding> findings;
  std::vector<Rejection> rejections;
  std::vector<std::string> warnings;

  void append(RunRecord other) {
    findings.insert(findings.end(), other.findings.begin(), other.findings.end());
    rejections.insert(rejections.end(), other.rejections.begin(), other.rejections.end());
    warnings.insert(warnings.end(), other.warnings.begin(), other.warnings.end());
  }
};

[[nodiscard]] constexpr const char* to_string(Finding::Action action) {
  switch (action) {
    case Finding::Action::repaired: return "repaired";
    case Finding::Action::removed: return "removed";
    case Finding::Action::split: return "split";
    case Finding::Action::noted: return "noted";
  }
  return "noted";
}

}  // namespace versine
