// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <unordered_map>
#include <vector>

#include "versine/network/build.hpp"

namespace versine::network::detail {

/// A line of the file in the network's map, before it is split.
struct Line {
  const SourceTrack* source = nullptr;
  std::string id;
  Polyline line;
  std::vector<double> cuts;    ///< inner distances at which it is split, sorted, distinct
  TrackIndex first_piece = 0;  ///< its pieces are first_piece ... first_piece + cuts.size()
};

struct Lines {
  std::vector<Line> lines;
  std::unordered_map<std::string, std::size_t> index;  ///< by id
};

/// Projects all lines; drops and reports those that are no track.
Lines project_lines(const NetworkSource& source, const std::vector<std::vector<Eigen::Vector2d>>& points,
                    const std::vector<std::vector<double>>& scales, RunRecord& record);

/// Finds where each line is split: at labelled connections, shared vertices, or ends that touch its inside.
void find_cuts(const NetworkSource& source, const BuildOptions& options, Lines& lines, RunRecord& record);

/// Fills network.tracks from the lines and their cuts.
void split_lines(Lines& lines, Network& network);

/// A transition that the map states, in terms of our tracks.
struct Label {
  OrientedTrack from, to;
  bool allowed = true;
};
std::vector<Label> labels_of(const NetworkSource& source, const BuildOptions& options, const Lines& lines,
                             RunRecord& record);

/// Groups track ends into joints: by place, by labels and by having been split there.
void join_ends(const NetworkSource& source, const BuildOptions& options, const Lines& lines,
               const std::vector<Label>& labels, Network& network);

/// Fills network.connections.
void find_connections(const BuildOptions& options, const Lines& lines, const std::vector<Label>& labels,
                      Network& network);

}  // namespace versine::network::detail
