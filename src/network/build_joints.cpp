// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "build_stages.hpp"

namespace versine::network::detail {

namespace {

std::uint32_t slot(TrackIndex track, End end) {
  return 2 * track + (end == End::end ? 1U : 0U);
}

class Groups {
 public:
  explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t find(std::uint32_t x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

struct Cell {
  std::int64_t x, y;
  bool operator==(const Cell&) const = default;
};
struct CellHash {
  std::size_t operator()(const Cell& c) const {
    // Unsigned: the products are meant to wrap around.
    return static_cast<std::uint64_t>(c.x) * 0x9E3779B97F4A7C15U ^
           static_cast<std::uint64_t>(c.y) * 0x2545F4914F6CDD1DU;
  }
};

/// Points within `radius` of each other, through a hash of cells of that size.
class NearPoints {
 public:
  explicit NearPoints(double radius) : radius_(std::max(radius, 1e-6)) {}
  template <class Visit>
  void visit_near(const Eigen::Vector2d& p, Visit visit) const {
    const Cell c = cell(p);
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        const auto it = cells_.find({c.x + dx, c.y + dy});
        if (it == cells_.end()) continue;
        for (const auto& [q, id] : it->second) {
          if ((p - q).norm() <= radius_) visit(id);
        }
      }
    }
  }
  void add(const Eigen::Vector2d& p, std::uint32_t id) { cells_[cell(p)].emplace_back(p, id); }

 private:
  [[nodiscard]] Cell cell(const Eigen::Vector2d& p) const {
    return {std::llround(p.x() / radius_), std::llround(p.y() / radius_)};
  }
  double radius_;
  std::unordered_map<Cell, std::vector<std::pair<Eigen::Vector2d, std::uint32_t>>, CellHash> cells_;
};

/// Where a connection arrives or departs: the piece and direction of running there.
std::optional<OrientedTrack> oriented(const Line& line, double fraction, int direction, bool leaving, double snap) {
  const double d = fraction * line.line.length();
  const bool at_begin = d <= snap, at_end = d >= line.line.length() - snap;
  if (direction == 0) {
    if (at_begin == at_end) return std::nullopt;  // inside, or a line shorter than the tolerance
    direction = (at_begin == leaving) ? 1 : -1;
    // Leaving into b at its beginning runs with its points; arriving on a at its end does too.
  }
  // Number of the cut at this place, counting the beginning as 0: piece `cut` begins there, piece `cut - 1` ends there.
  std::size_t cut = 0;
  if (at_end && !(at_begin && ((direction > 0) == leaving))) {
    cut = line.cuts.size() + 1;
  } else if (!at_begin) {
    const auto near = std::min_element(line.cuts.begin(), line.cuts.end(),
                                       [&](double a, double b) { return std::abs(a - d) < std::abs(b - d); });
    if (near == line.cuts.end()) return std::nullopt;
    cut = static_cast<std::size_t>(near - line.cuts.begin()) + 1;
  }
  // Running with the points one leaves into the piece that begins at the cut, and arrives on the one that ends there.
  const bool begins = (direction > 0) == leaving;
  if (begins ? cut > line.cuts.size() : cut == 0) return std::nullopt;  // runs off the end of the line
  return OrientedTrack{line.first_piece + static_cast<TrackIndex>(begins ? cut : cut - 1), direction < 0};
}

}  // namespace

std::vector<Label> labels_of(const NetworkSource& source, const BuildOptions& options, const Lines& lines,
                             RunRecord& record) {
  std::vector<Label> labels;
  for (const auto& c : source.connections) {
    const auto a = lines.index.find(c.a), b = lines.index.find(c.b);
    if (a == lines.index.end() || b == lines.index.end()) {
      record.warnings.push_back(fmt::format("{}: record {}: connection names the unknown track '{}', left out",
                                            source.file, c.record, a == lines.index.end() ? c.a : c.b));
      continue;
    }
    const auto from = oriented(lines.lines[a->second], c.at_a, c.direction_a, false, options.snap);
    const auto to = oriented(lines.lines[b->second], c.at_b, c.direction_b, true, options.snap);
    if (!from || !to) {
      record.warnings.push_back(fmt::format("{}: record {}: connection '{}' - '{}' leads off a track's end, left out",
                                            source.file, c.record, c.a, c.b));
      continue;
    }
    const auto n = c.navigability;
    labels.push_back({*from, *to, n == Navigability::both || n == Navigability::a_to_b});
    labels.push_back({to->opposite(), from->opposite(), n == Navigability::both || n == Navigability::b_to_a});
  }
  return labels;
}

void join_ends(const NetworkSource& source, const BuildOptions& options, const Lines& lines,
               const std::vector<Label>& labels, Network& network) {
  const std::size_t n = network.tracks.size();
  Groups groups(2 * n);
  NearPoints near(options.snap);
  for (std::uint32_t s = 0; s < 2 * n; ++s) {
    const Eigen::Vector2d& p = network.tracks[s / 2].line.at((s & 1U) != 0 ? End::end : End::begin);
    near.visit_near(p, [&](std::uint32_t other) {
      // A track shorter than the tolerance must not swallow its own other end.
      if (other / 2 != s / 2) groups.join(s, other);
    });
    near.add(p, s);
  }
  for (const auto& l : labels) {
    groups.join(slot(l.from.track, l.from.exit()), slot(l.to.track, l.to.entry()));
  }
  for (const auto& l : lines.lines) {
    for (TrackIndex k = 0; k < l.cuts.size(); ++k) {
      groups.join(slot(l.first_piece + k, End::end), slot(l.first_piece + k + 1, End::begin));
    }
  }

  std::vector<std::uint32_t> joint_of_group(2 * n, 0xFFFFFFFFU);
  network.joint_of.resize(2 * n);
  for (std::uint32_t s = 0; s < 2 * n; ++s) {
    auto& j = joint_of_group[groups.find(s)];
    if (j == 0xFFFFFFFFU) {
      j = static_cast<std::uint32_t>(network.joints.size());
      network.joints.emplace_back().place.setZero();
    }
    network.joint_of[s] = j;
    network.joints[j].ends.push_back({s / 2, (s & 1U) != 0 ? End::end : End::begin});
  }
  NearPoints nodes(options.snap);
  for (std::uint32_t j = 0; j < network.joints.size(); ++j) {
    auto& joint = network.joints[j];
    for (const auto& e : joint.ends) joint.place += network.tracks[e.track].line.at(e.end);
    joint.place /= static_cast<double>(joint.ends.size());
    for (const auto& e : joint.ends) {
      joint.spread = std::max(joint.spread, (network.tracks[e.track].line.at(e.end) - joint.place).norm());
    }
    if (!source.nodes.empty()) nodes.add(joint.place, j);
  }
  for (const auto& node : source.nodes) {
    Eigen::Vector2d p = node.point;
    p = source.crs.empty() ? network.to_map({p.y(), p.x(), 0.0}) : Eigen::Vector2d(p - network.origin);
    nodes.visit_near(p, [&](std::uint32_t j) { network.joints[j].kind = node.kind; });
  }
}

void find_connections(const BuildOptions& options, const Lines& lines, const std::vector<Label>& labels,
                      Network& network) {
  auto& out = network.connections;
  std::vector<char> labelled(2 * network.tracks.size(), 0);  // ends of which the map says something
  const auto deflection = [&](OrientedTrack from, OrientedTrack to) {
    const Eigen::Vector2d arriving = -network.tracks[from.track].line.inward(from.exit(), options.angle_base);
    const Eigen::Vector2d leaving = network.tracks[to.track].line.inward(to.entry(), options.angle_base);
    return std::acos(std::clamp(arriving.dot(leaving), -1.0, 1.0));
  };
  for (const auto& l : labels) {
    labelled[slot(l.from.track, l.from.exit())] = labelled[slot(l.to.track, l.to.entry())] = 1;
    network.joints[network.joint_of[slot(l.from.track, l.from.exit())]].labelled = true;
    if (l.allowed) out.push_back({l.from, l.to, deflection(l.from, l.to), true, false});
  }
  if (!labels.empty()) {  // where a labelled line was split one can of course go straight on
    for (const auto& l : lines.lines) {
      for (TrackIndex k = 0; k < l.cuts.size(); ++k) {
        const OrientedTrack before{l.first_piece + k, false}, after{l.first_piece + k + 1, false};
        out.push_back({before, after, 0.0, true, false});
        out.push_back({after.opposite(), before.opposite(), 0.0, true, false});
        labelled[slot(before.track, End::end)] = labelled[slot(after.track, End::begin)] = 1;
      }
    }
  }

  struct Turn {
    std::size_t a, b;
    double angle;
  };
  std::vector<Turn> turns;
  for (const auto& joint : network.joints) {
    turns.clear();
    const auto& ends = joint.ends;
    std::vector<double> straightest(ends.size(), INFINITY);
    for (std::size_t a = 0; a < ends.size(); ++a) {
      for (std::size_t b = a + 1; b < ends.size(); ++b) {
        if (labelled[slot(ends[a].track, ends[a].end)] || labelled[slot(ends[b].track, ends[b].end)]) continue;
        const OrientedTrack from{ends[a].track, ends[a].end == End::begin}, to{ends[b].track, ends[b].end == End::end};
        const double angle = deflection(from, to);
        if (!(angle < options.largest_turn)) continue;
        turns.push_back({a, b, angle});
        straightest[a] = std::min(straightest[a], angle);
        straightest[b] = std::min(straightest[b], angle);
      }
    }
    for (const auto& t : turns) {
      // On a diamond crossing one only goes straight on; on anything else every gentle turn may be a blade's.
      if (joint.kind == NodeKind::crossing && (t.angle > straightest[t.a] || t.angle > straightest[t.b])) continue;
      const OrientedTrack from{ends[t.a].track, ends[t.a].end == End::begin},
          to{ends[t.b].track, ends[t.b].end == End::end};
      out.push_back({from, to, t.angle, false, false});
      out.push_back({to.opposite(), from.opposite(), t.angle, false, false});
    }
  }

  const auto key = [](const Connection& c) { return std::pair(c.from.state(), c.to.state()); };
  std::sort(out.begin(), out.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  out.erase(std::unique(out.begin(), out.end(), [&](const auto& a, const auto& b) { return key(a) == key(b); }),
            out.end());
  for (std::size_t i = 0; i < out.size();) {
    std::size_t j = i, best = i;
    for (; j < out.size() && out[j].from == out[i].from; ++j) {
      if (out[j].deflection < out[best].deflection) best = j;
    }
    for (std::size_t k = i; k < j; ++k) out[k].diverging = k != best;
    i = j;
  }
}

}  // namespace versine::network::detail
