// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "versine/design/alignment.hpp"
#include "versine/design/audit.hpp"

namespace versine::design {

/// A horizontal element as a file states it. Directions in files follow several conventions (LandXML exports write
/// 2 pi - azimuth, degrees, gon), so headings are derived from the points.
struct RawElement {
  HorizontalElement element;
  MapPosition start;
  std::optional<MapPosition> end;  ///< when the format states it
  std::string where;               ///< for messages: "Spiral 12 (C41), line 88"
  bool kink_intended = false;      ///< the file says that the axis has a kink at its start
};

/// A design as a file states it. Distances are from the start of the first element.
struct RawAlignment {
  std::string file, name, crs;
  std::vector<RawElement> elements;
  std::vector<VerticalPoint> profile;
  std::vector<CantPoint> cant;
  std::vector<ChainageEquation> chainage;
  Audit findings;  ///< what the reader itself noticed
};

/// An alignment of a file with its audit. When something is refused there is no alignment, and the error names the
/// first element concerned; the audit is complete all the same.
struct Imported {
  std::string name;
  Audit audit;
  Expected<Alignment> alignment;
};

/// Puts a design together and audits it: gaps, kinks, lengths against points, curvature jumps, cant against curvature,
/// cant ramps against transitions, profile coverage, chainage jumps. Where end and start of neighbours differ a little,
/// both move to the middle, and each element is turned and scaled onto its joints, so that the axis is continuous.
[[nodiscard]] Imported assemble(const RawAlignment& raw, const AuditLimits& limits = {});

}  // namespace versine::design
