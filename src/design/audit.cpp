// SPDX-License-Identifier: Apache-2.0
#include "versine/design/audit.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace versine::design {

bool refused(const Audit& audit) {
  return std::any_of(audit.begin(), audit.end(),
                     [](const AuditFinding& f) { return f.verdict == AuditFinding::Verdict::refused; });
}

const char* to_string(AuditFinding::Verdict verdict) {
  switch (verdict) {
    case AuditFinding::Verdict::noted:
      return "noted";
    case AuditFinding::Verdict::healed:
      return "healed";
    case AuditFinding::Verdict::refused:
      return "refused";
  }
  return "noted";
}

std::string to_string(const AuditFinding& f) {
  std::string text = fmt::format("{:<8}{} at {:.3f} m", to_string(f.verdict), f.kind, f.distance);
  if (!f.element.empty()) text += ", " + f.element;
  if (!f.unit.empty()) text += fmt::format(": {:.4g} {}", f.value, f.unit);
  if (f.limit > 0.0) text += fmt::format(" (limit {:.4g} {})", f.limit, f.unit);
  if (!f.detail.empty()) text += "; " + f.detail;
  return text;
}

}  // namespace versine::design
