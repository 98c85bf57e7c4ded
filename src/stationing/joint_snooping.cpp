// SPDX-License-Identifier: Apache-2.0
#include "joint_snooping.hpp"

#include <algorithm>
#include <map>

#include "joint_window.hpp"
#include "point_matching.hpp"
#include "statistics.hpp"
#include "versine/geodesy/attitude.hpp"

namespace versine::stationing {
namespace {

constexpr std::size_t core = 6, margin = 3;  ///< stations judged together, and those on each side that help
constexpr std::size_t least_targets = 3;  ///< of a station; in between it may have one less, until another comes back
constexpr std::size_t unknowns = 7;       ///< of a station: position, theta, scale
constexpr double shared_turn = 1e-3;      ///< rad, of the plumb lines of one window
constexpr double weak = 10.0;             ///< m, rad, 1: determines nothing

/// A sighting of one station as the joint adjustment takes it, linear about the station's own solution.
struct Seen {
  std::size_t station, target;
  const ControlPoint* point;
  JointBlock block;  ///< in use where the station by itself used it
};

/// Residuals across, up and along, whitened by the instrument's sigmas alone: the control point is an unknown here.
JointBlock linearize(const Candidate& c, const StationResult& s, const Instrument& instrument) {
  ControlPoint exact = *c.point;
  exact.covariance.setZero();
  const Observation o = observe(*c.target, exact, {s.position, s.q_ms}, instrument);
  const Eigen::Matrix3d axes = line_axes({s.position, s.q_ms}, o.direction, o.zenith);
  const Eigen::Vector3d to_point = o.place - s.position;
  const Eigen::Vector3d v = s.q_ms.conjugate() * to_point;
  JointBlock b;
  // seen - place = (observed line - v) in the m-frame; it moves with the station, turns about it, and goes from the
  // point.
  b.observed = -o.whitening * misclosure<double>(v, s.scale, o.direction, o.zenith, o.distance);
  b.by_pose << o.whitening * axes, -o.whitening * axes * geodesy::skew(to_point), o.distance * o.whitening.col(2);
  b.by_point = -o.whitening * axes;
  return b;
}

/// What up in the instrument's axes tells of its attitude and of the turn that all plumb lines share.
JointBlock linearize(const Plumb& plumb, const StationResult& s) {
  const Eigen::Matrix3d C_ms = s.q_ms.toRotationMatrix();
  const Eigen::Vector3d told = C_ms * plumb.up_s;
  JointBlock b;
  b.observed = (up_at(s.position) - told) / plumb.sigma;
  b.by_pose.middleCols<3>(3) = -geodesy::skew(told) / plumb.sigma;
  b.by_point = -C_ms * geodesy::skew(plumb.up_s) / plumb.sigma;
  return b;
}

struct Critical {
  double sighting, point;
};

bool uses(const StationResult& s, const std::string& point) {
  return std::any_of(s.targets.begin(), s.targets.end(), [&](const TargetResult& t) { return t.point == point; });
}

/// One window: sightings first, coordinates behind them, plumb lines at the end.
class Window {
 public:
  Window(std::span<const Seen> seen, std::span<const SolvedStation> stations, std::size_t first, std::size_t last,
         const std::set<std::string>& moved, bool solve_scale)
      : first_(first), last_(last) {
    std::vector<JointBlock> blocks;
    const auto poses = static_cast<Eigen::Index>(unknowns * (last - first));
    std::map<const ControlPoint*, Eigen::Index> column;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (seen[i].station < first || seen[i].station >= last) continue;
      const auto [it, is_new] =
          column.try_emplace(seen[i].point, poses + static_cast<Eigen::Index>(3 * points_.size()));
      if (is_new) points_.push_back(seen[i].point);
      blocks.push_back(seen[i].block);
      blocks.back().pose = static_cast<Eigen::Index>(unknowns * (seen[i].station - first));
      blocks.back().point = it->second;
      sightings_.push_back(&seen[i]);
    }
    for (std::size_t p = 0; p < points_.size(); ++p) {
      JointBlock b{.point = poses + static_cast<Eigen::Index>(3 * p)};
      // A point given as exact is held to a hundredth of a millimetre.
      const Eigen::Matrix3d c = points_[p]->covariance + 1e-10 * Eigen::Matrix3d::Identity();
      b.by_point.setIdentity();
      c.llt().matrixL().solveInPlace(b.by_point);
      b.used = !moved.contains(points_[p]->name);
      blocks.push_back(b);
    }
    const auto turn = poses + static_cast<Eigen::Index>(3 * points_.size());
    for (std::size_t i = first; i < last; ++i) {
      if (!stations[i].plumb) continue;
      blocks.push_back(linearize(*stations[i].plumb, *stations[i].result));
      blocks.back().pose = static_cast<Eigen::Index>(unknowns * (i - first));
      blocks.back().point = turn;
      plumbed_.push_back(i);
    }
    Eigen::VectorXd sigma = Eigen::VectorXd::Constant(turn + 3, weak);
    sigma.tail<3>().setConstant(shared_turn);
    for (Eigen::Index i = unknowns - 1; !solve_scale && i < poses; i += unknowns) sigma[i] = 1e-9;
    window_.emplace(std::move(blocks), sigma);
  }

  /// The worst goes while a test fails; then what fits comes back, the best first, unless it makes another fail. What
  /// came back may show that what stayed was wrong: so again, until nothing changes.
  void snoop(const Critical& critical) {
    for (int round = 0; round < 4; ++round) {
      bool changed = false;
      while (const auto worst = failing(critical)) {
        window_->toggle(*worst);
        changed = true;
      }
      if (!readmit(critical) && !changed) return;
    }
  }

  /// Decisions on the stations from `from` to `to`.
  void tell(std::size_t from, std::size_t to, JointVerdict& verdict, std::map<std::string, MovedPoint>& moved,
            std::span<const SolvedStation> stations) const {
    for (std::size_t k = 0; k < plumbed_.size(); ++k) {
      const std::size_t i = plumbed_[k], block = sightings_.size() + points_.size() + k;
      if (i < from || i >= to || !window_->blocks()[block].used) continue;
      const Plumb& told = *stations[i].plumb;
      const Eigen::Vector3d turn = window_->solution().tail<3>();
      verdict.plumb[i] = Plumb{geodesy::from_rotation_vector(turn) * told.up_s,
                               std::hypot(told.sigma, window_->sigma(window_->blocks()[block].point, 3))};
    }
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
      const Seen& s = *sightings_[i];
      if (s.station < from || s.station >= to) continue;
      const std::size_t p = point_of(i);
      if (!window_->blocks()[i].used) verdict.left_out[s.station].insert(s.target);
      if (window_->blocks()[sightings_.size() + p].used) continue;
      verdict.left_out[s.station].insert(s.target);
      MovedPoint& m = moved[s.point->name];
      m.name = s.point->name;
      m.offset = window_->solution().segment<3>(window_->blocks()[i].point);
      m.stations.push_back(stations[s.station].readings->name);
    }
  }

 private:
  bool readmit(const Critical& critical) {
    std::vector<std::pair<double, std::size_t>> out;
    for (std::size_t i = 0; i < window_->blocks().size(); ++i) {
      if (!window_->blocks()[i].used) out.emplace_back(window_->test(i), i);
    }
    std::sort(out.begin(), out.end());
    bool changed = false;
    for (const auto& [before, i] : out) {
      if (before > limit(i, critical) || window_->test(i) > limit(i, critical)) continue;
      window_->toggle(i);
      const bool spoils = failing(critical).has_value();
      if (spoils) window_->toggle(i);
      changed = changed || !spoils;
    }
    return changed;
  }

  [[nodiscard]] double limit(std::size_t i, const Critical& c) const {
    const bool coordinates = i >= sightings_.size() && i < sightings_.size() + points_.size();
    return coordinates ? c.point : c.sighting;
  }
  [[nodiscard]] std::size_t point_of(std::size_t sighting) const {
    return (static_cast<std::size_t>(window_->blocks()[sighting].point) - unknowns * (last_ - first_)) / 3;
  }
  [[nodiscard]] std::size_t used_at(std::size_t station) const {
    std::size_t n = 0;
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
      n += sightings_[i]->station == station && window_->blocks()[i].used;
    }
    return n;
  }
  [[nodiscard]] std::size_t seen_by(std::size_t point) const {
    std::size_t n = 0;
    for (std::size_t i = 0; i < sightings_.size(); ++i) n += window_->blocks()[i].used && point_of(i) == point;
    return n;
  }

  [[nodiscard]] bool may_go(std::size_t i) const {
    if (i < sightings_.size()) return used_at(sightings_[i]->station) >= least_targets;
    return i >= sightings_.size() + points_.size() || seen_by(i - sightings_.size()) >= 2;
  }

  /// The block in use with the largest test, in terms of its critical value, that may go.
  [[nodiscard]] std::optional<std::size_t> failing(const Critical& critical) const {
    std::optional<std::size_t> worst;
    double largest = 1.0;
    for (std::size_t i = 0; i < window_->blocks().size(); ++i) {
      if (!window_->blocks()[i].used) continue;
      const double test = window_->test(i) / limit(i, critical);
      // Where two explain the same (a point seen once), the sighting is the likelier fault; it comes first here.
      if (!(test > largest * (1.0 + 1e-9))) continue;
      if (!may_go(i)) continue;
      largest = test;
      worst = i;
    }
    return worst;
  }

  std::size_t first_, last_;
  std::vector<const Seen*> sightings_;
  std::vector<const ControlPoint*> points_;
  std::vector<std::size_t> plumbed_;  ///< stations
  std::optional<JointWindow> window_;
};

}  // namespace

JointVerdict snoop_jointly(std::span<const SolvedStation> stations, const ControlNetwork& network,
                           const std::vector<MovedPoint>& known, const Instrument& instrument,
                           const FreeStationOptions& options) {
  JointVerdict verdict;
  verdict.left_out.resize(stations.size());
  verdict.plumb.resize(stations.size());
  std::set<std::string> moved_names;
  for (const MovedPoint& m : known) moved_names.insert(m.name);
  std::vector<Seen> seen;
  std::vector<std::set<std::size_t>> alone(stations.size());  // what each left out by itself
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const auto matching = match_points(*stations[i].readings, network, options);
    if (!matching) continue;
    for (const auto* group : {&matching->used, &matching->left_out}) {
      for (const Candidate& c : *group) {
        const auto target = static_cast<std::size_t>(c.target - stations[i].readings->targets.data());
        seen.push_back({i, target, c.point, linearize(c, *stations[i].result, instrument)});
        const bool used = uses(*stations[i].result, c.point->name);
        if (!used) alone[i].insert(target);
        // With a plumb line the station's own choice is open again: all begin in, but what is wrong by far.
        const bool again = stations[i].plumb && group == &matching->used;
        seen.back().block.used = used || again || moved_names.contains(c.point->name);
      }
    }
  }
  // That a marked point has moved is a rarer fault than a wrong sighting, and a worse one to claim.
  const Critical critical{chi_square_quantile(3, options.significance),
                          chi_square_quantile(3, 0.1 * options.significance)};
  std::map<std::string, MovedPoint> moved;
  for (std::size_t from = 0; from < stations.size(); from += core) {
    const std::size_t to = std::min(stations.size(), from + core);
    Window window(seen, stations, from - std::min(from, margin), std::min(stations.size(), to + margin), moved_names,
                  options.solve_scale);
    window.snoop(critical);
    window.tell(from, to, verdict, moved, stations);
  }
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const auto has = static_cast<std::size_t>(
        std::count_if(seen.begin(), seen.end(), [i](const Seen& s) { return s.station == i; }));
    const bool enough = has >= verdict.left_out[i].size() + least_targets;
    verdict.changed.push_back(enough && alone[i] != verdict.left_out[i]);
  }
  for (auto& [name, m] : moved) verdict.moved.push_back(std::move(m));
  return verdict;
}

}  // namespace versine::stationing
