// SPDX-License-Identifier: Apache-2.0
#include "versine/design/alignment.hpp"

namespace versine::design {

DesignPoint Alignment::at(double distance) const {
  DesignPoint p;
  static_cast<AxisPose&>(p) = horizontal.at(distance);
  p.distance = distance;
  const VerticalPose v = profile.at(distance);
  p.height = v.height;
  p.gradient = v.gradient;
  p.vertical_curvature = v.curvature;
  const CantPose c = cant.at(distance);
  p.cant = c.cant;
  p.cant_rate = c.rate;
  return p;
}

}  // namespace versine::design
