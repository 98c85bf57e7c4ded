// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace versine::network {

/// A railway map as its file tells it, before anything is concluded from it. Readers (io/network_*) make it,
/// `build` (network/build.hpp) turns it into a Network.

struct SourceTrack {
  std::string id;
  std::vector<Eigen::Vector2d>
      points;              ///< easting, northing in m of `crs`; longitude, latitude in rad when it is empty
  std::size_t record = 0;  ///< 1-based feature number in the file
  std::optional<double> mileage_begin;  ///< m, of the first point, where the map tells it
  std::optional<double> mileage_end;    ///< m, of the last point
  std::optional<double> length;         ///< m on the ground, where the map tells it; only checked against ours
};

enum class Navigability : unsigned char {
  both,    ///< in either direction
  a_to_b,  ///< from a to b only
  b_to_a,
  none,  ///< the tracks meet there, but no wheel can go from one to the other
};

/// A statement of the map about two tracks that meet.
struct SourceConnection {
  std::string a, b;
  double at_a = 0.0, at_b = 0.0;  ///< where along each track, as a fraction of its length, 0 to 1
  /// Direction of running on each when going from a to b: +1 with the track's points, -1 against them, 0: as the
  /// fraction says (away from a's far end, into b), for fractions of 0 and 1.
  int direction_a = 0, direction_b = 0;
  Navigability navigability = Navigability::both;
  std::size_t record = 0;
};

/// What a map says about a point where tracks meet.
enum class NodeKind : unsigned char { unknown, switch_, slip, crossing, buffer_stop };
struct SourceNode {
  Eigen::Vector2d point;  ///< as SourceTrack::points
  NodeKind kind = NodeKind::unknown;
};

struct NetworkSource {
  std::string file;
  std::string crs;  ///< of the points, for geodesy::Projection; empty: WGS84 longitude and latitude
  std::vector<SourceTrack> tracks;
  std::vector<SourceConnection> connections;
  std::vector<SourceNode> nodes;
  /// Lines that share an inner vertex meet there (OpenStreetMap's rule) and are split at it.
  bool share_inner_vertices = false;
};

}  // namespace versine::network
