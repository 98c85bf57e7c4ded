// SPDX-License-Identifier: Apache-2.0
#include "versine/geodesy/project_map.hpp"

namespace versine::geodesy {

MapPoint ProjectMap::forward(const Geodetic& place) const {
  MapPoint p = projection.forward(place);
  p.height = place.height;  // PROJ may carry heights along into another datum; here that is HeightDatum's work
  p.height = heights.apply(place, p);
  if (!similarity) return p;
  const Eigen::Vector3d x = similarity->apply({p.easting, p.northing, p.height});
  return {x.x(), x.y(), x.z()};
}

Projection::Distortion ProjectMap::distortion(const Geodetic& place) const {
  Projection::Distortion d = projection.distortion(place);
  if (similarity) {
    // Coordinates that turn counter-clockwise mean axes that turned clockwise.
    d.scale *= similarity->scale;
    d.convergence += similarity->rotation_z();
  }
  return d;
}

}  // namespace versine::geodesy
