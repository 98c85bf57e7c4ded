// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>

#include "versine/network/network.hpp"

namespace versine::network {

/// Finds tracks near a place. Immutable and safe to share between threads; refers to the network it was made of.
class SpatialIndex {
 public:
  explicit SpatialIndex(const Network& network);
  SpatialIndex(SpatialIndex&&) noexcept;
  ~SpatialIndex();

  struct Hit {
    TrackIndex track = 0;
    double distance = 0.0;  ///< of the nearest point from the track's beginning, m
    double offset = 0.0;    ///< m
  };
  /// Each track that comes within `radius` of a map point (relative to Network::origin), nearest first.
  [[nodiscard]] std::vector<Hit> near(const Eigen::Vector2d& p, double radius) const;

 private:
  struct Tree;
  const Network* network_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace versine::network
