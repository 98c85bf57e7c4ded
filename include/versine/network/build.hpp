// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/core/error.hpp"
#include "versine/network/network.hpp"

namespace versine::network {

struct BuildOptions {
  /// Map projection to work in; empty: the file's own when it is projected, else a transverse Mercator of scale 1 on
  /// the network's middle meridian. "utm": the zone of the network's middle.
  std::string crs;
  double snap = 1.0;             ///< ends nearer than this are one joint, m; those not equal are listed as near misses
  double largest_turn = 0.5236;  ///< a wheel passes an unlabelled joint when its deflection is below this, rad (30 deg)
  double angle_base = 15.0;      ///< length of the chord that gives an end its direction, m
};

/// Turns a map file's content into a network: projects it, drops what is no track (zero length, no number, repeated),
/// splits lines where others meet their inside, joins ends, and finds the transitions: the map's own labels where a
/// joint has any, the angle between both ends' directions elsewhere. Everything dropped, snapped or doubtful is in
/// `record`. Fails when nothing is left, when coordinates in degrees come without a CRS, or when the CRS is unknown.
[[nodiscard]] Expected<Network> build(const NetworkSource& source, const BuildOptions& options = {});

}  // namespace versine::network
