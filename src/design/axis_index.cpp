// SPDX-License-Identifier: Apache-2.0
#include "versine/design/axis_index.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace versine::design {

namespace {

constexpr double piece_length = 25.0;  // m
constexpr double piece_turn = 0.1;     // rad; keeps the foot unique within a piece for points within 10 radii of turn

double largest_curvature(const HorizontalElement& e) {
  double k = std::max(std::abs(e.curvature_start), std::abs(e.curvature_end));
  // The Viennese bend swings out of its end values: |x^2 (1 - 4x + 5x^2 - 2x^3)| stays below 0.021 within [0, 1].
  if (e.shape == Shape::viennese) k += 420.0 * 0.021 * std::abs(e.cant_term) / (e.length * e.length);
  return k;
}

struct Offset {
  double along, across;  // of a point against a pose: forward and right, m
};
Offset against(const MapPose& p, double easting, double northing) {
  const double c = std::cos(p.heading), s = std::sin(p.heading);
  const double e = easting - p.easting, n = northing - p.northing;
  return {s * e + c * n, c * e - s * n};
}

}  // namespace

struct AxisIndex::Search {
  double easting, northing;
  AxisRange range;
  double best_squared = std::numeric_limits<double>::infinity();
  AxisFoot foot;
  void offer(const AxisFoot& candidate, double squared) {
    // Two pieces share their joint: the foot inside one of them is the better description of the same place.
    const bool same = candidate.inside && !foot.inside && squared <= best_squared * (1.0 + 1e-12);
    if (!(squared < best_squared) && !same) return;
    best_squared = squared;
    foot = candidate;
  }
};

AxisIndex::AxisIndex(HorizontalAxis axis) : axis_(std::move(axis)) {
  std::vector<Box> boxes;
  for (std::size_t e = 0; e < axis_.elements().size(); ++e) {
    const auto& placed = axis_.elements()[e];
    const double length = placed.element.length, k = largest_curvature(placed.element);
    const auto n = static_cast<int>(std::ceil(std::max(length / piece_length, k * length / piece_turn)));
    MapPose last = placed.start;
    for (int i = 0; i < std::max(n, 1); ++i) {
      const double from = placed.distance + length * i / std::max(n, 1);
      const double to = placed.distance + length * (i + 1) / std::max(n, 1);
      const MapPose next = axis_.at(to, e);
      pieces_.push_back({from, to, e, last, next});
      const double swell = k * (to - from) * (to - from) / 8.0 * 1.01 + 1e-6;  // the arc bulges over its chord
      boxes.push_back({std::min(last.easting, next.easting) - swell, std::min(last.northing, next.northing) - swell,
                       std::max(last.easting, next.easting) + swell, std::max(last.northing, next.northing) + swell});
      last = next;
    }
  }
  leaves_ = std::bit_ceil(pieces_.size());
  constexpr double far = std::numeric_limits<double>::infinity();
  tree_.assign(2 * leaves_, {far, far, -far, -far});
  std::copy(boxes.begin(), boxes.end(), tree_.begin() + static_cast<std::ptrdiff_t>(leaves_));
  for (std::size_t i = leaves_ - 1; i > 0; --i) {
    const Box &a = tree_[2 * i], &b = tree_[2 * i + 1];
    tree_[i] = {std::min(a.west, b.west), std::min(a.south, b.south), std::max(a.east, b.east),
                std::max(a.north, b.north)};
  }
}

/// Solves (point - axis(s)) . tangent(s) = 0 on the piece: Newton, kept inside a shrinking bracket.
void AxisIndex::try_piece(std::size_t index, Search& search) const {
  const Piece& piece = pieces_[index];
  double low = std::max(piece.from, search.range.from), high = std::min(piece.to, search.range.to);
  if (!(low < high)) return;
  const Offset at_start = against(piece.start, search.easting, search.northing);
  const Offset at_end = against(piece.end, search.easting, search.northing);
  const double slope = at_start.along - at_end.along;
  double s = piece.from + (slope > 0.0 ? at_start.along / slope : 0.5) * (piece.to - piece.from);
  s = std::clamp(s, low, high);
  const double first = low, last = high;
  bool first_tried = false, last_tried = false;
  for (int i = 0; i < 100; ++i) {
    const AxisPose pose = axis_.at(s, piece.element);
    const Offset o = against(pose, search.easting, search.northing);
    // Derivative of `along` by s is -(1 - curvature * across); zero at the centre of curvature, where halving helps.
    const double step = o.along / std::max(1.0 - pose.curvature * o.across, 1e-30);
    const bool stuck = (s == first && o.along <= 0.0) || (s == last && o.along >= 0.0);
    if (stuck || std::abs(step) < 1e-10 || high - low < 1e-10) {
      search.offer({s, o.across, piece.element, !stuck || std::abs(o.along) < 1e-9},
                   o.along * o.along + o.across * o.across);
      return;
    }
    (o.along > 0.0 ? low : high) = s;
    first_tried = first_tried || s == first;
    last_tried = last_tried || s == last;
    const double next = s + step;
    if (next > low && next < high) {
      s = next;
    } else if (next >= last && !last_tried) {
      s = last;
    } else if (next <= first && !first_tried) {
      s = first;
    } else {
      s = 0.5 * (low + high);
    }
  }
}

void AxisIndex::descend(std::size_t node, std::size_t first, std::size_t last, Search& search) const {
  const auto lower_bound = [&](std::size_t i) {
    const Box& b = tree_[i];
    const double e = std::max({b.west - search.easting, 0.0, search.easting - b.east});
    const double n = std::max({b.south - search.northing, 0.0, search.northing - b.north});
    return e * e + n * n;
  };
  // Pieces below this node.
  const std::size_t depth = static_cast<std::size_t>(std::bit_width(leaves_) - std::bit_width(node));
  const std::size_t begin = (node << depth) - leaves_, end = ((node + 1) << depth) - leaves_;
  if (end <= first || begin >= last || lower_bound(node) > search.best_squared) return;
  if (node >= leaves_) return try_piece(begin, search);
  const bool left_first = lower_bound(2 * node) <= lower_bound(2 * node + 1);
  descend(2 * node + (left_first ? 0 : 1), first, last, search);
  descend(2 * node + (left_first ? 1 : 0), first, last, search);
}

AxisFoot AxisIndex::project(double easting, double northing, const AxisRange& range) const {
  const double length = axis_.length();
  Search search{easting, northing, range};
  // At least a millimetre of axis is searched, wherever the range lies.
  search.range.from = std::min(std::max(range.from, 0.0), length - std::min(1e-3, 0.5 * length));
  search.range.to = std::max(std::min(range.to, length), search.range.from + std::min(1e-3, 0.5 * length));
  const auto by_end = [](const Piece& p, double d) { return p.to < d; };
  const auto first = std::lower_bound(pieces_.begin(), pieces_.end(), search.range.from, by_end);
  const auto last = std::lower_bound(first, pieces_.end(), search.range.to, by_end);
  const auto begin = static_cast<std::size_t>(first - pieces_.begin());
  const auto end = std::min(static_cast<std::size_t>(last - pieces_.begin()) + 1, pieces_.size());
  descend(1, begin, end, search);
  AxisFoot foot = search.foot;
  // Beyond an end of the axis the end tangent serves.
  if (!foot.inside && (foot.distance == 0.0 || foot.distance == length)) {
    const Offset o = against(foot.distance == 0.0 ? pieces_.front().start : pieces_.back().end, easting, northing);
    if (foot.distance == 0.0 ? o.along < 0.0 : o.along > 0.0) {
      foot.distance += o.along;
      foot.offset = o.across;
    }
  }
  // The nearest place is a joint with a slight kink: inside all the same.
  if (!foot.inside && foot.distance > search.range.from && foot.distance < search.range.to) foot.inside = true;
  return foot;
}

MapPose AxisIndex::place(double distance, double offset) const {
  MapPose p = axis_.at(distance);
  p.easting += offset * std::cos(p.heading);
  p.northing -= offset * std::sin(p.heading);
  return p;
}

std::vector<AxisFoot> project_run(const AxisIndex& index, std::span<const MapPosition> points, double search,
                                  const AxisRange& start) {
  std::vector<AxisFoot> feet;
  feet.reserve(points.size());
  for (const MapPosition& p : points) {
    AxisFoot foot;
    if (feet.empty()) {
      foot = index.project(p.easting, p.northing, start);
    } else {
      const double near = feet.back().distance;
      foot = index.project(p.easting, p.northing, {near - search, near + search});
      const bool at_axis_end = foot.distance <= 0.0 || foot.distance >= index.axis().length();
      if (!foot.inside && !at_axis_end) foot = index.project(p.easting, p.northing);
    }
    feet.push_back(foot);
  }
  return feet;
}

}  // namespace versine::design
