// SPDX-License-Identifier: Apache-2.0
#include "versine/network/spatial_index.hpp"

#include <algorithm>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>

namespace versine::network {

namespace {
namespace bg = boost::geometry;
using Point = bg::model::point<float, 2, bg::cs::cartesian>;
using Box = bg::model::box<Point>;

/// A few segments together: a tenth of the boxes, and the scan inside one is cheaper than descending to it.
struct Chunk {
  TrackIndex track;
  std::uint32_t first, last;  // segments [first, last)
};
constexpr std::size_t chunk_size = 8;
}  // namespace

struct SpatialIndex::Tree {
  using Value = std::pair<Box, Chunk>;
  using Index = bg::index::rtree<Value, bg::index::rstar<16>>;
  Index tree;
};

SpatialIndex::SpatialIndex(const Network& network) : network_(&network) {
  std::vector<std::pair<Box, Chunk>> boxes;
  for (TrackIndex t = 0; t < network.tracks.size(); ++t) {
    const auto& points = network.tracks[t].line.points();
    for (std::size_t i = 0; i + 1 < points.size(); i += chunk_size) {
      const std::size_t last = std::min(i + chunk_size, points.size() - 1);
      Eigen::Vector2d low = points[i], high = low;
      for (std::size_t k = i; k <= last; ++k) low = low.cwiseMin(points[k]), high = high.cwiseMax(points[k]);
      // A float is exact to 6 cm at 500 km: boxes are made that much larger.
      const Eigen::Vector2f a = (low.array() - 0.1).cast<float>(), b = (high.array() + 0.1).cast<float>();
      boxes.emplace_back(Box{{a.x(), a.y()}, {b.x(), b.y()}},
                         Chunk{t, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(last)});
    }
  }

  tree_ = std::make_unique<Tree>(Tree{Tree::Index(boxes.begin(), boxes.end())});
}
SpatialIndex::SpatialIndex(SpatialIndex&&) noexcept = default;
SpatialIndex::~SpatialIndex() = default;

std::vector<SpatialIndex::Hit> SpatialIndex::near(const Eigen::Vector2d& p, double radius) const {
  std::vector<Hit> hits;
  const auto x = static_cast<float>(p.x()), y = static_cast<float>(p.y()), r = static_cast<float>(radius);
  for (auto it = tree_->tree.qbegin(bg::index::intersects(Box{{x - r, y - r}, {x + r, y + r}}));
       it != tree_->tree.qend(); ++it) {
    const Chunk& c = it->second;
    const auto at = network_->tracks[c.track].line.project(p, c.first, c.last);
    if (at.offset > radius) continue;
    const auto same = std::find_if(hits.begin(), hits.end(), [&](const Hit& h) { return h.track == c.track; });
    if (same == hits.end()) {
      hits.push_back({c.track, at.distance, at.offset});
    } else if (at.offset < same->offset) {
      *same = {c.track, at.distance, at.offset};
    }
  }
  std::sort(hits.begin(), hits.end(),
            [](const Hit& a, const Hit& b) { return std::pair(a.offset, a.track) < std::pair(b.offset, b.track); });
  return hits;
}

}  // namespace versine::network
