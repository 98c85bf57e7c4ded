// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace versine::design {

/// Something the audit of an imported design found.
struct AuditFinding {
  enum class Verdict {
    noted,    ///< kept as it is
    healed,   ///< small; the axis was made continuous there
    refused,  ///< too large: the alignment is not used
  };
  Verdict verdict = Verdict::noted;
  std::string kind;       ///< "gap", "kink", "length", "curvature jump", "cant against curvature", "chainage jump", ...
  std::string element;    ///< "Spiral 12 (C41), line 88"
  double distance = 0.0;  ///< along the axis, m
  double value = 0.0;     ///< in `unit`
  double limit = 0.0;     ///< in `unit`; 0 when there is none
  std::string unit;       ///< "m", "rad", "1/m"
  std::string detail;     ///< for a person
};

/// What the audit looks for, and when it refuses. Defaults suit designs written with millimetres.
struct AuditLimits {
  double gap_noted = 1e-4;             ///< m between the end of an element and the start of the next
  double gap_refused = 0.02;           ///< m; also for an element that is longer or shorter than its end points say
  double kink_noted = 1e-4;            ///< rad
  double kink_refused = 2e-3;          ///< rad, where it also displaces the shorter neighbour's far end by gap_refused
  double curvature_jump_noted = 1e-6;  ///< 1/m
  double cant_noted = 1e-3;            ///< m of cant with the wrong sign, or on a straight
  double cant_refused = 0.3;           ///< m; no track has that much
  double ramp_noted = 1.0;             ///< m between the ends of a cant ramp and of its transition
};

/// Findings in order of kind and distance.
using Audit = std::vector<AuditFinding>;

[[nodiscard]] bool refused(const Audit& audit);
[[nodiscard]] const char* to_string(AuditFinding::Verdict verdict);
/// One line: `healed gap at 1+234.567, Curve 7: 0.0009 m (limit 0.02 m)`.
[[nodiscard]] std::string to_string(const AuditFinding& finding);

}  // namespace versine::design
