// SPDX-License-Identifier: Apache-2.0
#include "versine/stationing/free_station.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "adjustment.hpp"
#include "diagnosis.hpp"
#include "statistics.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/stationing/geometry_verdict.hpp"

namespace versine::stationing {
namespace {

/// A target with the control point that it is taken for.
struct Candidate {
  const Target* target;
  const ControlPoint* point;
  bool renamed = false;
};

Eigen::Vector3d local(const Target& t) {
  const double s = std::sin(t.zenith);
  return t.distance * Eigen::Vector3d(s * std::cos(t.direction), s * std::sin(t.direction), -std::cos(t.zenith));
}

Eigen::Vector3d prism(const ControlPoint& point, double target_height) {
  return point.position + target_height * up_at(point.position);
}

Observation observe(const Target& t, const ControlPoint& point, const Pose& pose, const Instrument& instrument) {
  Observation o{
      .place = prism(point, t.target_height), .direction = t.direction, .zenith = t.zenith, .distance = t.distance};
  const double target2 = instrument.target_sigma * instrument.target_sigma;
  const Eigen::Vector3d sigma(t.distance * std::sin(t.zenith) * t.direction_sigma, t.distance * t.zenith_sigma,
                              t.distance_sigma);
  const Eigen::Matrix3d axes = line_axes(pose, t.direction, t.zenith);
  o.covariance = axes * point.covariance * axes.transpose();
  o.covariance.diagonal() += sigma.cwiseAbs2() + Eigen::Vector3d::Constant(target2);
  o.whitening = Eigen::Matrix3d::Identity();
  o.covariance.llt().matrixL().solveInPlace(o.whitening);
  return o;
}

/// What the readings say about the place of a target, against its coordinates, and whether that is believable.
struct Discrepancy {
  Eigen::Vector3d offset;  ///< m-frame, m
  double test = 0.0;       ///< chi-square, 3 d.o.f.
};
Discrepancy predict(const Candidate& c, const Adjustment& a, const Instrument& instrument) {
  const Observation o = observe(*c.target, *c.point, a.pose, instrument);
  const Eigen::Vector3d seen = a.pose.position + a.pose.q_ms * (a.scale * local(*c.target));
  const Eigen::Vector3d offset = seen - o.place;
  const Eigen::Matrix3d axes = line_axes(a.pose, o.direction, o.zenith);
  Eigen::Matrix3d covariance = axes.transpose() * o.covariance * axes;
  Eigen::Matrix<double, 3, 7> j;
  j << Eigen::Matrix3d::Identity(), -geodesy::skew(seen - a.pose.position), (seen - a.pose.position) / a.scale;
  covariance += j * a.covariance * j.transpose();
  return {offset, offset.dot(covariance.llt().solve(offset))};
}

/// Tests of one target in an adjustment that holds it: T = v' R^-1 v with R the target's block of I - H.
TargetResult test_target(const Candidate& c, const Observation& o, const Adjustment& a, std::size_t i,
                         double detectable) {
  TargetResult r{.point = c.point->name, .readings = c.target->readings};
  const Eigen::Matrix3d block = Eigen::Matrix3d::Identity() - a.jacobian[i] * a.covariance * a.jacobian[i].transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(block);
  // A direction in which the target alone carries the station cannot be tested: it has no redundancy.
  for (int k = 0; k < 3; ++k) {
    if (eigen.eigenvalues()(k) > 1e-6) {
      const double part = eigen.eigenvectors().col(k).dot(a.whitened[i]);
      r.point_test += part * part / eigen.eigenvalues()(k);
    }
  }
  const Eigen::Matrix3d unwhiten = o.whitening.inverse();
  r.residual = unwhiten * a.whitened[i];
  r.redundancy = (unwhiten * block * o.whitening).diagonal();
  const Eigen::Vector3d weighted = o.whitening.transpose() * a.whitened[i];
  const Eigen::Vector3d spread = (o.whitening.transpose() * block * o.whitening).diagonal().cwiseMax(0.0).cwiseSqrt();
  for (int k = 0; k < 3; ++k) {
    const bool tested = r.redundancy(k) > 1e-6;
    r.normalized(k) = tested ? weighted(k) / spread(k) : 0.0;
    r.detectable(k) = tested ? detectable / spread(k) : std::numeric_limits<double>::infinity();
  }
  return r;
}

/// The state of the search for what contradicts the rest.
struct Search {
  std::vector<Candidate> used, left_out;
  std::vector<Observation> observations;
  Adjustment adjustment;
  std::vector<TargetResult> tests;
};

class Solver {
 public:
  Solver(const ReducedStation& station, const ControlNetwork& network, const Instrument& instrument,
         const FreeStationOptions& options)
      : station_(station),
        network_(network),
        instrument_(instrument),
        options_(options),
        critical_(chi_square_quantile(3, options.significance)),
        detectable_(noncentrality_root(options.significance, options.power)) {}

  Expected<StationResult> solve() {
    result_.name = station_.name;
    result_.from = station_.from;
    result_.to = station_.to;
    result_.warnings = station_.warnings;
    name_candidates();
    if (auto ok = start(); !ok) return tl::unexpected(ok.error());
    if (auto ok = refine(); !ok) return tl::unexpected(ok.error());
    snoop();
    readmit();
    return finish();
  }

 private:
  Error error(std::string found, std::string expected, std::string advice) const {
    return {.line = station_.targets.empty() ? 0 : station_.targets.front().line,
            .field = fmt::format("station {}", station_.name),
            .found = std::move(found),
            .expected = std::move(expected),
            .advice = std::move(advice)};
  }

  /// Numbers to control points; what has none is kept for identification by coordinates.
  void name_candidates() {
    for (const Target& t : station_.targets) {
      if (std::isnan(t.distance)) {
        result_.excluded.push_back({.point = t.point, .reason = Exclusion::Reason::no_distance});
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
      (consensus->agrees[i] ? search_.used : search_.left_out).push_back(candidates_[i]);
    }
    search_.adjustment.pose = consensus->pose;
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
      return fail(error("targets without known numbers whose figure fits more than one place of the network",
                        "one place", "give the numbers of the points, or the rough position of the station (near)"));
    }
    for (std::size_t i = 0; i < targets.size(); ++i) {
      if (found->point[i] == nullptr) {
        result_.excluded.push_back({.point = targets[i]->point, .reason = Exclusion::Reason::unknown_point});
        continue;
      }
      note_name(*targets[i], *found->point[i]);
      search_.used.push_back({targets[i], found->point[i], targets[i]->point != found->point[i]->name});
    }
    unnamed_.clear();
    search_.adjustment.pose = found->pose;
    return Expected<void>{};
  }

  void note_name(const Target& t, const ControlPoint& is) {
    if (t.point == is.name) return;
    result_.warnings.push_back(t.point.empty()
                                   ? fmt::format("a target without number is {}", is.name)
                                   : fmt::format("target '{}' is {}, by its coordinates", t.point, is.name));
    if (!t.point.empty() && network_.find(t.point) != nullptr) {
      result_.excluded.push_back({.point = t.point, .reason = Exclusion::Reason::wrong_name, .is = is.name});
    }
  }

  bool taken(const ControlPoint* p) const {
    return std::any_of(search_.used.begin(), search_.used.end(), [&](const Candidate& c) { return c.point == p; });
  }

  /// Targets without number, and targets whose number contradicts the rest, are looked up where they point.
  void identify_rest() {
    const Pose& pose = search_.adjustment.pose;
    const auto look_up = [&](const Target& t) -> const ControlPoint* {
      const Eigen::Vector3d seen = pose.position + pose.q_ms * local(t);
      const ControlPoint* p = network_.nearest(seen - t.target_height * up_at(seen), options_.tolerance);
      return p != nullptr && !taken(p) ? p : nullptr;
    };
    for (const Target* t : unnamed_) {
      if (const ControlPoint* p = look_up(*t)) {
        note_name(*t, *p);
        search_.used.push_back({t, p, true});
      } else {
        result_.excluded.push_back({.point = t->point, .reason = Exclusion::Reason::unknown_point});
      }
    }
    unnamed_.clear();
    std::vector<Candidate> still;
    for (const Candidate& c : search_.left_out) {
      if (const ControlPoint* p = look_up(*c.target); p != nullptr && p != c.point) {
        note_name(*c.target, *p);
        search_.used.push_back({c.target, p, true});
      } else {
        still.push_back(c);
      }
    }
    search_.left_out = std::move(still);
  }

  Error no_start(const std::vector<Pair>& pairs, std::size_t least) const {
    if (pairs.size() < least) {
      return error(fmt::format("{} usable of {} targets", pairs.size(), station_.targets.size()),
                   fmt::format("at least {} targets on control points, with distances", least),
                   "are the numbers those of the control list, and is the list that of this line?");
    }
    return diagnose_start(pairs, options_.tolerance, options_.largest_tilt,
                          error("no three targets agree with the control points", "three or more that do", ""));
  }

  void observe_used() {
    search_.observations.clear();
    for (const Candidate& c : search_.used) {
      search_.observations.push_back(observe(*c.target, *c.point, search_.adjustment.pose, instrument_));
    }
  }

  void readjust(bool robust) {
    observe_used();
    search_.adjustment = adjust(search_.observations, search_.adjustment.pose, search_.adjustment.scale,
                                {options_.solve_scale, options_.tilt_sigma, robust});
    search_.tests.clear();
    if (!search_.adjustment.regular || robust) return;
    for (std::size_t i = 0; i < search_.used.size(); ++i) {
      search_.tests.push_back(
          test_target(search_.used[i], search_.observations[i], search_.adjustment, i, detectable_));
    }
  }

  Expected<void> refine() {
    readjust(true);
    readjust(false);
    if (!search_.adjustment.regular) {
      return fail(error("targets that lie on a line", "points that span at least a triangle",
                        "use back-sights on both sides of the track, ahead and behind"));
    }
    const auto& a = search_.adjustment;
    if (const auto constant = common_distance_error(search_.observations, a); constant && a.redundancy > 5) {
      return fail(
          error(fmt::format("all distances {:.1f} mm too {}", std::abs(constant->value) * 1e3,
                            constant->value > 0.0 ? "long" : "short"),
                fmt::format("distances that fit the control points (what is left: {:.1f} sigma)", constant->test),
                "this looks like a prism constant applied twice, or not at all: set prism_constant_mm to what "
                "the instrument has not applied itself"));
    }
    return {};
  }

  /// The worst target goes, one at a time, as long as a test fails and enough remain to tell.
  void snoop() {
    const std::size_t least = options_.tilt_sigma ? 3 : 4;
    while (search_.used.size() >= least && search_.adjustment.redundancy > 0) {
      const auto worst = std::max_element(search_.tests.begin(), search_.tests.end(),
                                          [](const auto& a, const auto& b) { return a.point_test < b.point_test; });
      if (worst == search_.tests.end() || worst->point_test <= critical_) return;
      const auto i = worst - search_.tests.begin();
      Search before = search_;
      search_.left_out.push_back(search_.used[static_cast<std::size_t>(i)]);
      search_.used.erase(search_.used.begin() + i);
      readjust(false);
      if (!search_.adjustment.regular) {  // the rest cannot carry the station: keep it and say so
        search_ = std::move(before);
        result_.warnings.push_back(fmt::format("{} fails its test, but the station cannot do without it",
                                               search_.tests[static_cast<std::size_t>(i)].point));
        return;
      }
    }
  }

  /// A target that fell while another blunder was still in comes back when it fits the final solution.
  void readmit() {
    for (std::size_t round = 0; round < 3 && !search_.left_out.empty(); ++round) {
      std::size_t best = 0;
      double smallest = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < search_.left_out.size(); ++i) {
        const double test = predict(search_.left_out[i], search_.adjustment, instrument_).test;
        if (test < smallest && !taken(search_.left_out[i].point)) smallest = test, best = i;
      }
      if (smallest > critical_) return;
      const Search before = search_;
      search_.used.push_back(search_.left_out[best]);
      search_.left_out.erase(search_.left_out.begin() + static_cast<std::ptrdiff_t>(best));
      readjust(false);
      const auto worst = std::max_element(search_.tests.begin(), search_.tests.end(),
                                          [](const auto& a, const auto& b) { return a.point_test < b.point_test; });
      if (worst->point_test > critical_) {
        search_ = before;
        return;
      }
    }
  }

  Expected<StationResult> finish() {
    const Adjustment& a = search_.adjustment;
    for (const Candidate& c : search_.left_out) {
      const Discrepancy d = predict(c, a, instrument_);
      result_.excluded.push_back({.point = c.point->name, .offset = d.offset, .test = d.test});
    }
    result_.position = a.pose.position;
    result_.q_ms = a.pose.q_ms;
    result_.scale = a.scale;
    result_.covariance = a.covariance;
    result_.redundancy = a.redundancy;
    result_.sigma0 = a.redundancy > 0 ? std::sqrt(a.squares / a.redundancy) : 0.0;
    result_.targets = search_.tests;
    std::vector<Eigen::Vector3d> lines;
    for (const Candidate& c : search_.used) lines.push_back(local(*c.target));
    result_.geometry = judge_geometry(lines, result_, options_.wanted_sigma);
    if (a.redundancy > 0 && a.squares > chi_square_quantile(a.redundancy, 1e-4)) {
      result_.warnings.push_back(
          fmt::format("residuals are {:.1f} times what the instrument's and the control points' "
                      "sigmas promise",
                      result_.sigma0));
    }
    return std::move(result_);
  }

  const ReducedStation& station_;
  const ControlNetwork& network_;
  const Instrument& instrument_;
  const FreeStationOptions& options_;
  double critical_, detectable_;
  std::vector<Candidate> candidates_;
  std::vector<const Target*> unnamed_;
  Search search_;
  StationResult result_;
};

}  // namespace

Expected<StationResult> free_station(const ReducedStation& station, const ControlNetwork& network,
                                     const Instrument& instrument, const FreeStationOptions& options) {
  return Solver(station, network, instrument, options).solve();
}

LocatedPoint locate(const StationResult& station, const Target& target, const Instrument& instrument) {
  const Eigen::Vector3d arm = station.q_ms * (station.scale * local(target));
  const ControlPoint place{.name = target.point, .position = station.position + arm};
  const Pose pose{station.position, station.q_ms};
  const Eigen::Matrix3d axes = line_axes(pose, target.direction, target.zenith);
  Eigen::Matrix<double, 3, 7> j;
  j << Eigen::Matrix3d::Identity(), -geodesy::skew(arm), arm / station.scale;
  return {place.position - target.target_height * up_at(place.position),
          j * station.covariance * j.transpose() +
              axes.transpose() * observe(target, place, pose, instrument).covariance * axes};
}

}  // namespace versine::stationing
