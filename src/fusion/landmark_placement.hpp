// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/fusion/landmark_adjustment.hpp"
#include "versine/fusion/landmark_dead_reckoning.hpp"

/// How the nominal path of dead reckoning is laid onto the landmarks.
namespace versine::fusion::landmark {

/// The node nearest in time.
[[nodiscard]] std::size_t node_at(const std::vector<Node>& nodes, Time t);

/// Roll by the accelerometers over the standstill at a landmark; none when it was too short.
[[nodiscard]] std::optional<RollTie> roll_tie(const sensors::ImuSeries& imu, const sensors::LandmarkSample& l,
                                              const Node& node, std::size_t k, const LandmarkOptions& o);

/// How the nominal path lies, how the landmarks fit it, and the channels linearised there.
struct Placement {
  double heading = 0.0, scale = 0.0;
  double heading_sigma = 0.0;  ///< rad, at the start, as the landmarks leave it
  std::vector<Tie> ties;
  std::vector<Fit> fits;
  std::vector<Stretch> stretches;
  Channels channels;
};

/// Turns, scales and shifts the nodes of `r` until the channels' corrections are small; landmarks that contradict the
/// rest are left out. `turned`: what earlier passes have added to the heading of the alignment.
[[nodiscard]] Placement place(Reckoning& r, const LandmarkInput& in, const std::vector<std::size_t>& usable,
                              const StaticStart& start, const Prior& prior, const DrivingNoise& noise,
                              std::span<const filter::SmoothedEpoch<roll::size>> roll, double turned,
                              const LandmarkOptions& o);

}  // namespace versine::fusion::landmark
