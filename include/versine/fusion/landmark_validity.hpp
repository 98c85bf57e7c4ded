// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "versine/fusion/landmark_reckoning.hpp"

/// Where the reduced model (small angles, constant equivalent bias, channels that do not couple) holds. What it leaves
/// out grows with the change of cant and heading between two landmarks; here it is put into numbers, given to the
/// filters as noise, and the run warns where it counts.
namespace versine::fusion::landmark {

/// Standard deviations of what the model leaves out.
struct ModelErrors {
  double mounting = 0.0;           ///< rad, each mounting angle
  double level = 0.0;              ///< rad, roll and pitch
  double heading = 0.0;            ///< rad, at the alignment
  double gyro_scale = 0.0;         ///< 1
  double gyro_misalignment = 0.0;  ///< rad
  double bias = 0.0;               ///< rad/s, of the gyros as left by the alignment
  double latitude = 0.0;           ///< rad
};

/// A stretch between two landmarks, or before the first or after the last.
struct Stretch {
  std::size_t first = 0, last = 0;  ///< nodes
  double begin = 0.0;               ///< m travelled from the start
  double length = 0.0;              ///< m
  double duration = 0.0;            ///< s
  double cant_range = 0.0;          ///< rad: largest minus smallest roll
  double heading_range = 0.0;       ///< rad
  double heading_rate = 0.0;        ///< rad/s: largest magnitude
  double heading_rate_range = 0.0;  ///< rad/s
  double model_error = 0.0;         ///< m: sigma of lateral or vertical position by what the model leaves out
  ModelNoise noise;                 ///< that error as noise for the channels
};

/// Splits the run at the nodes `landmarks` (ascending) and judges each stretch.
[[nodiscard]] std::vector<Stretch> judge_stretches(std::span<const Node> nodes, std::span<const std::size_t> landmarks,
                                                   const ModelErrors& errors);

}  // namespace versine::fusion::landmark
