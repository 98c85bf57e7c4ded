// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "versine/core/run_record.hpp"
#include "versine/geodesy/projection.hpp"
#include "versine/network/polyline.hpp"
#include "versine/network/source.hpp"

/// The railway map: tracks that meet only at their ends, and which way a wheel can take there.
namespace versine::network {

using TrackIndex = std::uint32_t;

/// A piece of track between two joints. A line of the file that others meet in its inside was split there; `line_id`
/// and `line_offset` lead back to the file's own track and distance.
struct Track {
  std::string id;            ///< unique: the file's own, with "[k]" appended to the k-th piece of a split line
  std::string line_id;       ///< the file's own
  double line_offset = 0.0;  ///< distance of this piece's beginning from the beginning of the file's line, m
  Polyline line;             ///< map m relative to Network::origin; distances in ground m
  std::optional<double> mileage_begin, mileage_end;  ///< m
};

/// A track with a direction of running: a state of the oriented graph. `reversed`: from its end to its beginning.
struct OrientedTrack {
  TrackIndex track = 0;
  bool reversed = false;
  auto operator<=>(const OrientedTrack&) const = default;

  [[nodiscard]] std::uint32_t state() const { return 2 * track + (reversed ? 1U : 0U); }
  [[nodiscard]] static OrientedTrack from_state(std::uint32_t s) { return {s / 2, (s & 1U) != 0}; }
  [[nodiscard]] OrientedTrack opposite() const { return {track, !reversed}; }
  [[nodiscard]] End entry() const { return reversed ? End::end : End::begin; }
  [[nodiscard]] End exit() const { return reversed ? End::begin : End::end; }
};

struct TrackEnd {
  TrackIndex track = 0;
  End end = End::begin;
  auto operator<=>(const TrackEnd&) const = default;
};

/// A place where track ends meet (or one ends alone).
struct Joint {
  Eigen::Vector2d place;  ///< mean of the ends, relative to Network::origin
  std::vector<TrackEnd> ends;
  NodeKind kind = NodeKind::unknown;
  bool labelled = false;  ///< the map itself says which transitions exist
  double spread = 0.0;    ///< largest distance of an end from the place, map m
};

/// A way through a joint that a wheel can take. `to` is entered where `from` is left.
struct Connection {
  OrientedTrack from, to;
  double deflection = 0.0;  ///< angle between both ends' directions, rad, 0 straight on
  bool labelled = false;
  bool diverging = false;  ///< another way out of `from` is straighter
};

struct Network {
  std::string file;
  geodesy::Projection projection;  ///< of the map; a map point of ours is `projection` minus `origin`
  Eigen::Vector2d origin;
  std::vector<Track> tracks;
  std::vector<Joint> joints;
  std::vector<Connection> connections;  ///< sorted by from.state(), then to.state()
  std::vector<std::uint32_t> joint_of;  ///< index of the joint at 2 * track + (end ? 1 : 0)
  RunRecord record;                     ///< what was mended, dropped or noted while building

  [[nodiscard]] Eigen::Vector2d to_map(const geodesy::Geodetic& g) const {
    const auto p = projection.forward(g);
    return {p.easting - origin.x(), p.northing - origin.y()};
  }
  [[nodiscard]] geodesy::Geodetic to_geodetic(const Eigen::Vector2d& p) const {
    return projection.inverse({p.x() + origin.x(), p.y() + origin.y(), 0.0});
  }
  [[nodiscard]] const Joint& joint(TrackIndex track, End end) const {
    return joints[joint_of[2 * track + (end == End::end ? 1U : 0U)]];
  }
};

}  // namespace versine::network
