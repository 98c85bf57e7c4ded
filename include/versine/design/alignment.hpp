// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "versine/design/cant.hpp"
#include "versine/design/chainage.hpp"
#include "versine/design/horizontal.hpp"
#include "versine/design/vertical.hpp"

namespace versine::design {

/// Distance between the rail-head centres that cant refers to (EN 13848), m.
inline constexpr double cant_base = 1.5;

/// Everything the design says at one place.
struct DesignPoint : AxisPose {
  double distance = 0.0;            ///< along the axis from its start, map metres
  double height = 0.0;              ///< m; NaN when the alignment has no profile
  double gradient = 0.0;            ///< ratio, positive uphill; NaN when there is no profile
  double vertical_curvature = 0.0;  ///< 1/m, positive in a sag; NaN when there is no profile
  double cant = 0.0;                ///< m over cant_base, positive: left rail higher; NaN when there is no cant
  double cant_rate = 0.0;           ///< d cant / d distance; NaN when there is no cant
};

/// The line as designed (LandXML's and IFC's *Alignment*). A value: copy it, share it between threads.
/// All distances are map metres along the horizontal axis from its start; all places are map coordinates in `crs`.
struct Alignment {
  HorizontalAxis horizontal;
  Profile profile;
  CantProfile cant;
  Chainage chainage;
  std::string name;
  std::string crs;  ///< as geodesy::Projection takes it ("EPSG:25832"); empty when the source did not say

  [[nodiscard]] double length() const { return horizontal.length(); }
  [[nodiscard]] DesignPoint at(double distance) const;
  [[nodiscard]] double mileage(double distance) const { return chainage.mileage(distance); }
};

}  // namespace versine::design
