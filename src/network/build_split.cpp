// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cstring>

#include "build_stages.hpp"

namespace versine::network::detail {

namespace {

std::string where(const SourceTrack& t) {
  return fmt::format("record {} ('{}')", t.record, t.id);
}

/// Bit-equal coordinates: vertices that a file shares are written alike.
struct VertexKey {
  Eigen::Vector2d p;
  bool operator==(const VertexKey& o) const { return p == o.p; }
};
struct VertexHash {
  std::size_t operator()(const VertexKey& k) const {
    std::uint64_t x = 0, y = 0;
    std::memcpy(&x, &k.p.x(), 8);
    std::memcpy(&y, &k.p.y(), 8);
    x ^= y * 0x9E3779B97F4A7C15ULL;
    return static_cast<std::size_t>((x ^ (x >> 29)) * 0xBF58476D1CE4E5B9ULL);
  }
};

void cut_at_labels(const NetworkSource& source, const BuildOptions& options, Lines& lines) {
  const auto cut = [&](const std::string& id, double fraction) {
    const auto it = lines.index.find(id);
    if (it == lines.index.end()) return;
    Line& line = lines.lines[it->second];
    const double d = fraction * line.line.length();
    if (d > options.snap && d < line.line.length() - options.snap) line.cuts.push_back(d);
  };
  for (const auto& c : source.connections) cut(c.a, c.at_a), cut(c.b, c.at_b);
}

void cut_at_shared_vertices(Lines& lines) {
  std::unordered_map<VertexKey, std::uint32_t, VertexHash> uses;
  std::size_t total = 0;
  for (const auto& l : lines.lines) total += l.line.points().size();
  uses.reserve(total);
  for (const auto& l : lines.lines) {
    for (const auto& p : l.line.points()) ++uses[{p}];
  }
  for (auto& l : lines.lines) {
    const auto& points = l.line.points();
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      if (uses[{points[i]}] > 1) l.cuts.push_back(l.line.distances()[i]);
    }
  }
}

namespace bg = boost::geometry;
using Point = bg::model::point<double, 2, bg::cs::cartesian>;
using Box = bg::model::box<Point>;

void cut_where_ends_touch(const BuildOptions& options, Lines& lines, RunRecord& record) {
  std::vector<std::pair<Box, std::size_t>> boxes;
  for (std::size_t i = 0; i < lines.lines.size(); ++i) {
    Eigen::Vector2d low = lines.lines[i].line.points().front(), high = low;
    for (const auto& p : lines.lines[i].line.points()) low = low.cwiseMin(p), high = high.cwiseMax(p);
    boxes.emplace_back(Box{{low.x(), low.y()}, {high.x(), high.y()}}, i);
  }
  const bg::index::rtree<std::pair<Box, std::size_t>, bg::index::rstar<16>> tree(boxes);
  std::vector<std::pair<Box, std::size_t>> hits;
  std::size_t count = 0;
  for (std::size_t i = 0; i < lines.lines.size(); ++i) {
    for (const End end : {End::begin, End::end}) {
      const Eigen::Vector2d p = lines.lines[i].line.at(end);
      hits.clear();
      const double r = options.snap;
      tree.query(bg::index::intersects(Box{{p.x() - r, p.y() - r}, {p.x() + r, p.y() + r}}), std::back_inserter(hits));
      for (const auto& [box, j] : hits) {
        auto& other = lines.lines[j];
        if (j == i) continue;
        const auto at = other.line.project(p);
        if (at.offset > r || at.distance < r || at.distance > other.line.length() - r) continue;
        other.cuts.push_back(at.distance);
        ++count;
      }
    }
  }
  if (count > 0) record.warnings.push_back(fmt::format("{} ends of tracks meet another inside: split there", count));
}

}  // namespace

Lines project_lines(const NetworkSource& source, const std::vector<std::vector<Eigen::Vector2d>>& points,
                    const std::vector<std::vector<double>>& scales, RunRecord& record) {
  Lines out;
  out.lines.reserve(source.tracks.size());
  out.index.reserve(source.tracks.size());
  const auto drop = [&](const SourceTrack& t, const char* why) {
    record.warnings.push_back(fmt::format("{}: {}: {}, left out", source.file, where(t), why));
  };
  for (std::size_t i = 0; i < source.tracks.size(); ++i) {
    const auto& t = source.tracks[i];
    if (std::any_of(points[i].begin(), points[i].end(), [](const auto& p) { return !p.allFinite(); })) {
      drop(t, "a coordinate is not a number or outside the projection");
      continue;
    }
    const bool distinct = std::any_of(points[i].begin(), points[i].end(),
                                      [&](const auto& p) { return (p - points[i].front()).norm() > 1e-3; });
    if (!distinct) {
      drop(t, "zero length");
      continue;
    }
    std::string id = t.id;
    if (const auto it = out.index.find(id); it != out.index.end()) {
      const auto& same = *out.lines[it->second].source;
      if (same.points == t.points) {
        drop(t, fmt::format("repeats {}", where(same)).c_str());
        continue;
      }
      for (int k = 2; out.index.contains(id); ++k) id = fmt::format("{}#{}", t.id, k);
      record.warnings.push_back(
          fmt::format("{}: {}: identifier of {} again, renamed '{}'", source.file, where(t), where(same), id));
    }
    out.index.emplace(id, out.lines.size());
    out.lines.push_back({&t, std::move(id), Polyline(points[i], scales[i]), {}, 0});
  }
  return out;
}

void find_cuts(const NetworkSource& source, const BuildOptions& options, Lines& lines, RunRecord& record) {
  cut_at_labels(source, options, lines);
  if (source.share_inner_vertices) {
    cut_at_shared_vertices(lines);
  } else if (source.connections.empty()) {
    cut_where_ends_touch(options, lines, record);
  }
  for (auto& l : lines.lines) {
    std::sort(l.cuts.begin(), l.cuts.end());
    // Two that name the same place a few centimetres apart would leave a piece shorter than the map is exact.
    const double apart = source.share_inner_vertices ? 1e-3 : 0.1;
    l.cuts.erase(std::unique(l.cuts.begin(), l.cuts.end(), [&](double a, double b) { return b - a < apart; }),
                 l.cuts.end());
  }
}

void split_lines(Lines& lines, Network& network) {
  for (auto& l : lines.lines) {
    l.first_piece = static_cast<TrackIndex>(network.tracks.size());
    const double length = l.line.length();
    const auto mileage = [&](double d) -> std::optional<double> {
      const auto& s = *l.source;
      if (!s.mileage_begin || !s.mileage_end) return std::nullopt;
      return *s.mileage_begin + (*s.mileage_end - *s.mileage_begin) * d / length;
    };
    for (std::size_t k = 0; k <= l.cuts.size(); ++k) {
      const double from = k == 0 ? 0.0 : l.cuts[k - 1], to = k == l.cuts.size() ? length : l.cuts[k];
      network.tracks.push_back({l.cuts.empty() ? l.id : fmt::format("{}[{}]", l.id, k + 1), l.id, from,
                                l.cuts.empty() ? l.line : l.line.part(from, to), mileage(from), mileage(to)});
    }
  }
}

}  // namespace versine::network::detail
