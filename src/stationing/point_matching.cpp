// SPDX-License-Identifier: Apache-2.0
#include "point_matching.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis.hpp"

namespace versine::stationing {
namespace {

class Matcher {
 public:
  Matcher(const ReducedStation& station, const ControlNetwork& network, const FreeStationOptions& options)
      : station_(station), network_(network), options_(options) {}

  Expected<Matching> match() {
    name_candidates();
    if (auto ok = start(); !ok) return tl::unexpected(ok.error());
    return std::move(out_);
  }

 private:
  /// Numbers to control points; what has none is kept for identification by coordinates.
  void name_candidates() {
    for (const Target& t : station_.targets) {
      if (std::isnan(t.distance)) {
        out_.excluded.push_back({.point = t.point, .reason = Exclusion::Reason::no_distance});
      } else if (const ControlPoint* p = t.point.empty() ? nullptr : network_.find(t.point)) {
        candidates_.push_back({&t, p});
      } else {
        unnamed_.push_back(&t);
      }
    }
  }

  std::vector<Pair> pairs_of(const std::vector<Candidate>& candidates) const {
    std::vector<Pair> pairs;
    for (const Candidate& c : candidates) pairs.push_back({local(*c.target), prism(*c.point, c.target->target_height)});
    return pairs;
  }

  Expected<void> start() {
    const bool levelled = options_.tilt_sigma.has_value();
    const std::size_t least = levelled ? 2 : 3;
    const auto pairs = pairs_of(candidates_);
    auto consensus = candidates_.size() < least
                         ? std::nullopt
                         : find_consensus(pairs, options_.tolerance, options_.largest_tilt, levelled);
    const bool contradicted = consensus && 2 * consensus->count < candidates_.size() + 1;
    if ((!consensus || contradicted) && options_.identify) {
      if (auto found = identify_all(levelled)) return *found;
    }
    if (!consensus) return fail(no_start(pairs, least));
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      (consensus->agrees[i] ? out_.used : out_.left_out).push_back(candidates_[i]);
    }
    out_.pose = consensus->pose;
    if (options_.identify) identify_rest();
    return {};
  }

  /// Numbers are missing or wrong in the majority: the figure of the targets against the whole network.
  std::optional<Expected<void>> identify_all(bool levelled) {
    std::vector<Eigen::Vector3d> points;
    std::vector<const Target*> targets;
    for (const Target& t : station_.targets) {
      if (std::isnan(t.distance)) continue;
      targets.push_back(&t);
      points.push_back(local(t));
    }
    const auto found = identify(points, network_, options_.tolerance, options_.largest_tilt, levelled, options_.near);
    if (!found || found->count < 4) return {};
    if (found->ambiguous) {
      return fail(
          station_error(station_, "targets without known numbers whose figure fits more than one place of the network",
                        "one place", "give the numbers of the points, or the rough position of the station (near)"));
    }
    for (std::size_t i = 0; i < targets.size(); ++i) {
      if (found->point[i] == nullptr) {
        out_.excluded.push_back({.point = targets[i]->point, .reason = Exclusion::Reason::unknown_point});
        continue;
      }
      note_name(*targets[i], *found->point[i]);
      out_.used.push_back({targets[i], found->point[i]});
    }
    unnamed_.clear();
    out_.pose = found->pose;
    return Expected<void>{};
  }

  void note_name(const Target& t, const ControlPoint& is) {
    if (t.point == is.name) return;
    out_.warnings.push_back(t.point.empty() ? fmt::format("a target without number is {}", is.name)
                                            : fmt::format("target '{}' is {}, by its coordinates", t.point, is.name));
    if (!t.point.empty() && network_.find(t.point) != nullptr) {
      out_.excluded.push_back({.point = t.point, .reason = Exclusion::Reason::wrong_name, .is = is.name});
    }
  }

  bool taken(const ControlPoint* p) const {
    return std::any_of(out_.used.begin(), out_.used.end(), [&](const Candidate& c) { return c.point == p; });
  }

  /// Targets without number, and targets whose number contradicts the rest, are looked up where they point.
  void identify_rest() {
    const Pose& pose = out_.pose;
    const auto look_up = [&](const Target& t) -> const ControlPoint* {
      const Eigen::Vector3d seen = pose.position + pose.q_ms * local(t);
      const ControlPoint* p = network_.nearest(seen - t.target_height * up_at(seen), options_.tolerance);
      return p != nullptr && !taken(p) ? p : nullptr;
    };
    for (const Target* t : unnamed_) {
      if (const ControlPoint* p = look_up(*t)) {
        note_name(*t, *p);
        out_.used.push_back({t, p});
      } else {
        out_.excluded.push_back({.point = t->point, .reason = Exclusion::Reason::unknown_point});
      }
    }
    unnamed_.clear();
    std::vector<Candidate> still;
    for (const Candidate& c : out_.left_out) {
      if (const ControlPoint* p = look_up(*c.target); p != nullptr && p != c.point) {
        note_name(*c.target, *p);
        out_.used.push_back({c.target, p});
      } else {
        still.push_back(c);
      }
    }
    out_.left_out = std::move(still);
  }

  Error no_start(const std::vector<Pair>& pairs, std::size_t least) const {
    if (pairs.size() < least) {
      return station_error(station_, fmt::format("{} usable of {} targets", pairs.size(), station_.targets.size()),
                           fmt::format("at least {} targets on control points, with distances", least),
                           "are the numbers those of the control list, and is the list that of this line?");
    }
    return diagnose_start(
        pairs, options_.tolerance, options_.largest_tilt,
        station_error(station_, "no three targets agree with the control points", "three or more that do", ""));
  }

  const ReducedStation& station_;
  const ControlNetwork& network_;
  const FreeStationOptions& options_;
  std::vector<Candidate> candidates_;
  std::vector<const Target*> unnamed_;
  Matching out_;
};

}  // namespace

Expected<Matching> match_points(const ReducedStation& station, const ControlNetwork& network,
                                const FreeStationOptions& options) {
  return Matcher(station, network, options).match();
}

Error station_error(const ReducedStation& station, std::string found, std::string expected, std::string advice) {
  return {.line = station.targets.empty() ? 0 : station.targets.front().line,
          .field = fmt::format("station {}", station.name),
          .found = std::move(found),
          .expected = std::move(expected),
          .advice = std::move(advice)};
}

}  // namespace versine::stationing
