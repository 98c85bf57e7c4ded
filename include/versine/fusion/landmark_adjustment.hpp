// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "versine/fusion/landmark_model.hpp"
#include "versine/fusion/landmark_options.hpp"
#include "versine/fusion/landmark_reckoning.hpp"
#include "versine/fusion/landmark_validity.hpp"

/// The statistical half of landmark dead reckoning: from nominal nodes and landmarks to smoothed errors at every node.
namespace versine::fusion::landmark {

/// A landmark as the channels see it: at which node, how far the nominal path misses it, how well it is known.
struct Tie {
  std::size_t node = 0;
  std::size_t landmark = 0;                              ///< index in the input
  Eigen::Vector3d misclosure = Eigen::Vector3d::Zero();  ///< estimate minus landmark, n-frame, m
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< m^2
};
/// Roll from the accelerometers while standing, minus roll as reckoned.
struct RollTie {
  std::size_t node = 0;
  double difference = 0.0;  ///< rad
  double variance = 0.0;    ///< rad^2
};

/// What is known at node 0.
struct Prior {
  double position = 0.0;  ///< m, each direction
  double scale = 0.0, pitch = 0.0, heading = 0.0, bias = 0.0;
  double roll = 0.0;  ///< rad: error of levelling, which all rolls from accelerometers share
};

struct Channels {
  std::vector<VerticalStep> vertical;
  std::vector<LevelStep> level;
  VerticalEstimate vertical_start;
  LevelEstimate level_start;
};

/// The steps between nodes without observations, with the noise of the stretch that each lies in.
[[nodiscard]] Channels build_channels(std::span<const Node> nodes, std::span<const Stretch> stretches,
                                      const Prior& prior, const DrivingNoise& noise);

/// How each landmark fits the others: Baarda's data snooping with the smoother's own covariances.
struct Fit {
  double horizontal = 0.0;  ///< normalised residual: square root of its chi-square over 2 degrees of freedom
  double vertical = 0.0;    ///< normalised residual
  double redundancy = 0.0;  ///< 0: nothing else checks this landmark; 1: all else is known exactly
  bool used = true;
  [[nodiscard]] double worst() const { return horizontal > vertical ? horizontal : vertical; }
};

/// Finds landmarks that contradict the rest: smooths, takes out the worst beyond `gate`, again until none is left.
/// Works on the chain from landmark to landmark, so that its cost does not depend on the length of the recording.
[[nodiscard]] std::vector<Fit> snoop(const Channels& channels, std::span<const Tie> ties, double gate);

/// Innovation of each tie that is used, in the forward pass.
struct ForwardInnovation {
  std::size_t landmark = 0;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();
  double nis = 0.0;
};

/// Roll at every node, from gyros and from the accelerometers while standing. It does not depend on the landmarks, but
/// their lever arms depend on it: 0.1 mrad moves a prism 1 m above the rail by 0.1 mm.
[[nodiscard]] std::vector<filter::SmoothedEpoch<roll::size>> smooth_roll(std::span<const Node> nodes,
                                                                         const Prior& prior, const DrivingNoise& noise,
                                                                         std::span<const RollTie> ties,
                                                                         LandmarkSmoother smoother);

struct Smoothed {
  std::vector<filter::SmoothedEpoch<vertical::size>> vertical;
  std::vector<filter::SmoothedEpoch<level::size>> level;
  std::vector<filter::SmoothedEpoch<roll::size>> roll;
  std::vector<ForwardInnovation> innovations;
};

/// Filters and smooths all nodes with the ties that `fits` keeps; `roll` as smoothed before.
[[nodiscard]] Smoothed smooth(Channels channels, std::span<const Tie> ties, std::span<const Fit> fits,
                              std::vector<filter::SmoothedEpoch<roll::size>> roll, LandmarkSmoother smoother);

/// Smoothed estimates at the nodes of the ties only: enough to place the nominal path anew.
struct AtTies {
  std::vector<filter::SmoothedEpoch<vertical::size>> vertical;
  std::vector<filter::SmoothedEpoch<level::size>> level;
  VerticalEstimate vertical_start;  ///< at node 0
  LevelEstimate level_start;
};
[[nodiscard]] AtTies smooth_at_ties(const Channels& channels, std::span<const Tie> ties, std::span<const Fit> fits);

}  // namespace versine::fusion::landmark
