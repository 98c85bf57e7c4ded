// SPDX-License-Identifier: Apache-2.0
#include "versine/georef/path_inference.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>

namespace versine::georef {

namespace {

using network::OrientedTrack;
constexpr std::uint32_t none = 0xFFFFFFFFU;

std::uint64_t mix(std::uint64_t hash, std::uint32_t state) {
  hash ^= state + 0x9E3779B97F4A7C15ULL + (hash << 6) + (hash >> 2);
  hash *= 0xBF58476D1CE4E5B9ULL;
  return hash ^ (hash >> 31);
}

/// Paths share their beginnings: a tree of oriented tracks.
struct Node {
  OrientedTrack track;
  std::uint32_t parent = none;
};

struct Entry {
  double cost = 0.0, prior = 0.0, astray = 0.0;
  std::uint64_t hash = 0;
  std::uint32_t node = none;
};

struct Candidate {
  OrientedTrack track;
  double distance = 0.0;  // in the direction of running
  double emission = 0.0;
  double astray = 0.0;  // the same where the fix is too bad for the filter
  std::vector<Entry> entries;
};

/// A way from one candidate's track into another's, as found by the search.
struct Leg {
  double length = 0.0;  // from the source candidate to the entry of `track`
  double prior = 0.0;
  OrientedTrack track;
  std::uint32_t parent = none;
};

struct Pending {
  Entry entry;  // node: of the predecessor
  std::uint32_t label = none;
};

class Search {
 public:
  Search(const Map& map, std::span<const Knot> knots, const InferenceOptions& options,
         std::span<const Constraint> constraints, std::span<const StartPlace> start)
      : map_(map), knots_(knots.begin(), knots.end()), options_(options), start_(start) {
    for (const auto& c : constraints) rules_.push_back(rule_of(c));
    log_straight_ = std::log1p(-options.diverging);
    log_diverging_ = std::log(options.diverging);
  }

  std::vector<Stretch> run() {
    std::vector<Stretch> out;
    std::size_t k = 0;
    while (k < knots_.size()) {
      auto alive = candidates(k);
      if (alive.empty()) {
        ++k;
        continue;
      }
      nodes_.clear();
      for (auto& c : alive) {
        nodes_.push_back({c.track, none});
        const double prior = k == 0 ? start_prior(c) : 0.0;
        c.entries.push_back({c.emission - prior, prior, c.astray, mix(0, c.track.state()),
                             static_cast<std::uint32_t>(nodes_.size() - 1)});
      }
      Stretch stretch{k, k, {}};
      std::size_t last = k, next = k + 1, misses = 0;
      for (; next < knots_.size(); ++next) {
        auto found = candidates(next);
        extend(alive, last, found, next);
        if (found.empty()) {
          // One bad fix is passed over; many in a row over some distance are a hole in the map or a lost vehicle.
          if (++misses > 12 && (knots_[next].point - knots_[last].point).norm() > 300.0) break;
          continue;
        }
        alive = std::move(found);
        last = next;
        misses = 0;
      }
      stretch.last = last;
      collect(alive, stretch);
      out.push_back(std::move(stretch));
      k = last + 1;
      if (next >= knots_.size() && last + 1 < knots_.size() && misses <= 12) break;  // a few stray fixes at the end
    }
    return out;
  }

 private:
  /// A constraint on the map's tracks.
  struct Rule {
    Time from, to;
    std::vector<char> allows;  // of each track
  };
  [[nodiscard]] Rule rule_of(const Constraint& c) const {
    Rule r{c.from, c.to, {}};
    r.allows.reserve(map_.network.tracks.size());
    for (const auto& t : map_.network.tracks) {
      const bool named =
          std::any_of(c.tracks.begin(), c.tracks.end(), [&](const auto& id) { return id == t.line_id || id == t.id; });
      r.allows.push_back(named != c.excluded);
    }
    return r;
  }
  /// Whether the vehicle may have been on the track between two times: a rule counts that holds all of it.
  [[nodiscard]] bool allowed(network::TrackIndex track, Time from, Time to) const {
    return std::all_of(rules_.begin(), rules_.end(),
                       [&](const Rule& r) { return from < r.from || r.to < to || r.allows[track] != 0; });
  }

  /// The vehicle stands where the journey before left it; a movement that nobody noticed has one chance in a thousand.
  [[nodiscard]] double start_prior(const Candidate& c) const {
    if (start_.empty()) return 0.0;
    double p = 1e-3;
    const double length = map_.graph.length(c.track), at = c.track.reversed ? length - c.distance : c.distance;
    for (const auto& s : start_) {
      if (s.track != c.track.track) continue;
      const double x = (at - s.distance) / std::hypot(s.sigma, knots_.front().sigma, 5.0);
      p += s.probability * std::exp(-0.5 * x * x);
    }
    return std::log(std::min(p, 1.0));
  }

  std::vector<Candidate> candidates(std::size_t k) {
    Knot& knot = knots_[k];
    std::vector<Candidate> out;
    double radius = std::max(options_.radius, 4.0 * knot.sigma);
    auto hits = map_.index.near(knot.point, radius);
    while (hits.empty() && radius < options_.farthest) {
      radius *= 2.0;
      hits = map_.index.near(knot.point, radius);
    }
    // Far from any track the receiver is astray: then its error is at least that large, and tracks not much farther
    // away are as likely.
    if (!hits.empty() && hits.front().offset > options_.radius) {
      knot.sigma = std::max(knot.sigma, 0.5 * hits.front().offset);
      hits = map_.index.near(knot.point, 2.0 * hits.front().offset);
    }
    if (hits.size() > 40) hits.resize(40);
    for (const auto& h : hits) {
      if (!allowed(h.track, knot.time, knot.time)) continue;
      const double length = map_.network.tracks[h.track].line.length(), x = h.offset / knot.sigma;
      const double emission = knot.weight * 2.5 * std::log1p(x * x / 4.0);  // Student's t, 4 degrees of freedom
      const double astray = knot.sigma > options_.largest_sigma ? emission : 0.0;
      out.push_back({{h.track, false}, h.distance, emission, astray, {}});
      out.push_back({{h.track, true}, length - h.distance, emission, astray, {}});
    }
    return out;
  }

  struct Bounds {
    double expected, spread, longest, backward;
    Time from, to;
  };
  [[nodiscard]] Bounds bounds(std::size_t from, std::size_t to) const {
    const double chord = (knots_[to].point - knots_[from].point).norm();
    const double dt = (knots_[to].time - knots_[from].time).seconds();
    const double sigma = std::hypot(knots_[from].sigma, knots_[to].sigma);
    double travelled = 0.0;
    for (std::size_t i = from + 1; i <= to && travelled >= 0.0; ++i) {
      travelled = knots_[i].travelled < 0.0 ? -1.0 : travelled + knots_[i].travelled;
    }
    const double expected = travelled >= 0.0 ? std::max(travelled, chord - 2.0 * sigma) : chord;
    // After a gap the chord says little about the way: it may lead around a hill.
    const bool gap = dt > 20.0 && travelled < 0.0;
    const double spread = std::max(3.0, sigma) + (gap ? 0.3 : 0.05) * expected;
    const double longest = std::min((gap ? 2.5 * expected + 500.0 : 1.3 * expected + 60.0) + 4.0 * sigma,
                                    options_.top_speed * dt + 60.0 + 4.0 * sigma);
    return {expected, spread, std::max(longest, 10.0), 10.0 + 4.0 * sigma, knots_[from].time, knots_[to].time};
  }

  void extend(const std::vector<Candidate>& alive, std::size_t from, std::vector<Candidate>& found, std::size_t to) {
    std::unordered_map<std::uint32_t, std::uint32_t> at;
    for (std::uint32_t j = 0; j < found.size(); ++j) at.emplace(found[j].track.state(), j);
    std::vector<std::vector<Pending>> pending(found.size());
    const Bounds b = bounds(from, to);
    labels_.clear();
    for (const auto& c : alive) {
      if (!c.entries.empty()) expand(c, b, at, found, pending);
    }
    for (std::size_t j = 0; j < found.size(); ++j) keep_best(pending[j], found[j]);
    std::erase_if(found, [](const Candidate& c) { return c.entries.empty(); });
    // What costs far more than the best will not come back.
    double best = INFINITY;
    for (const auto& c : found) best = std::min(best, c.entries.front().cost);
    for (auto& c : found) std::erase_if(c.entries, [&](const Entry& e) { return e.cost > best + 60.0; });
    std::erase_if(found, [](const Candidate& c) { return c.entries.empty(); });
  }

  void offer(const Candidate& from, const Bounds& b, double route, double prior, std::uint32_t label,
             const Candidate& to, std::vector<Pending>& pending) {
    const double misfit = std::abs(route - b.expected) / b.spread;
    const double cost = std::min(misfit, 12.0) - prior + to.emission;
    for (const auto& e : from.entries) {
      pending.push_back({{e.cost + cost, e.prior + prior, e.astray + to.astray, e.hash, e.node}, label});
    }
  }

  void expand(const Candidate& c, const Bounds& b, const std::unordered_map<std::uint32_t, std::uint32_t>& at,
              const std::vector<Candidate>& found, std::vector<std::vector<Pending>>& pending) {
    if (const auto same = at.find(c.track.state()); same != at.end()) {
      const double route = found[same->second].distance - c.distance;
      if (route > -b.backward && route < b.longest)
        offer(c, b, route, 0.0, none, found[same->second], pending[same->second]);
    }
    // Routes in order of length, a diverging leg counting some metres more; each state at most a few times.
    constexpr int most = 4;
    const auto worse = [&](std::uint32_t x, std::uint32_t y) {
      return labels_[x].length - 20.0 * labels_[x].prior > labels_[y].length - 20.0 * labels_[y].prior;
    };
    std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, decltype(worse)> queue(worse);
    std::unordered_map<std::uint32_t, int> visits;
    const auto leave = [&](OrientedTrack track, double length, double prior, std::uint32_t parent) {
      if (length > b.longest) return;
      const auto out = map_.graph.successors(track);
      for (const auto& arc : out) {
        if (!allowed(arc.to.track, b.from, b.to)) continue;
        double p = prior;
        if (out.size() > 1) {
          p += arc.diverging ? log_diverging_ - std::log(static_cast<double>(out.size() - 1)) : log_straight_;
        }
        labels_.push_back({length, p, arc.to, parent});
        queue.push(static_cast<std::uint32_t>(labels_.size() - 1));
      }
    };
    leave(c.track, std::max(0.0, map_.graph.length(c.track) - c.distance), 0.0, none);
    while (!queue.empty()) {
      const std::uint32_t id = queue.top();
      queue.pop();
      const Leg label = labels_[id];
      if (++visits[label.track.state()] > most) continue;
      if (const auto hit = at.find(label.track.state()); hit != at.end()) {
        const double route = label.length + found[hit->second].distance;
        if (route < b.longest) offer(c, b, route, label.prior, id, found[hit->second], pending[hit->second]);
      }
      leave(label.track, label.length + map_.graph.length(label.track), label.prior, id);
    }
  }

  void keep_best(std::vector<Pending>& pending, Candidate& to) {
    for (auto& p : pending) {
      chain_.clear();
      for (std::uint32_t l = p.label; l != none; l = labels_[l].parent) chain_.push_back(labels_[l].track.state());
      for (auto it = chain_.rbegin(); it != chain_.rend(); ++it) p.entry.hash = mix(p.entry.hash, *it);
    }
    std::sort(pending.begin(), pending.end(), [](const Pending& a, const Pending& b) {
      return std::pair(a.entry.cost, a.entry.hash) < std::pair(b.entry.cost, b.entry.hash);
    });
    for (const auto& p : pending) {
      if (to.entries.size() >= static_cast<std::size_t>(options_.paths)) break;
      if (std::any_of(to.entries.begin(), to.entries.end(), [&](const Entry& e) { return e.hash == p.entry.hash; }))
        continue;
      Entry e = p.entry;
      chain_.clear();
      for (std::uint32_t l = p.label; l != none; l = labels_[l].parent) chain_.push_back(labels_[l].track.state());
      for (auto it = chain_.rbegin(); it != chain_.rend(); ++it) {
        nodes_.push_back({OrientedTrack::from_state(*it), e.node});
        e.node = static_cast<std::uint32_t>(nodes_.size() - 1);
      }
      to.entries.push_back(e);
    }
  }

  void collect(const std::vector<Candidate>& alive, Stretch& stretch) const {
    std::vector<Entry> all;
    for (const auto& c : alive) all.insert(all.end(), c.entries.begin(), c.entries.end());
    std::sort(all.begin(), all.end(),
              [](const Entry& a, const Entry& b) { return std::pair(a.cost, a.hash) < std::pair(b.cost, b.hash); });
    for (const auto& e : all) {
      if (stretch.hypotheses.size() >= static_cast<std::size_t>(options_.paths)) break;
      Hypothesis h{{}, e.cost, e.prior, e.astray};
      for (std::uint32_t n = e.node; n != none; n = nodes_[n].parent) h.path.push_back(nodes_[n].track);
      std::reverse(h.path.begin(), h.path.end());
      stretch.hypotheses.push_back(std::move(h));
    }
  }

  const Map& map_;
  std::vector<Knot> knots_;  // with the sigmas that the map shows to be needed
  const InferenceOptions& options_;
  std::span<const StartPlace> start_;
  std::vector<Rule> rules_;
  double log_straight_ = 0.0, log_diverging_ = 0.0;
  std::vector<Node> nodes_;
  std::vector<Leg> labels_;
  std::vector<std::uint32_t> chain_;
};

}  // namespace

std::vector<Stretch> infer_paths(const Map& map, std::span<const Knot> knots, const InferenceOptions& options,
                                 std::span<const Constraint> constraints, std::span<const StartPlace> start) {
  return Search(map, knots, options, constraints, start).run();
}

}  // namespace versine::georef
