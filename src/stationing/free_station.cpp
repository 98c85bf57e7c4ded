// SPDX-License-Identifier: Apache-2.0
#include "versine/stationing/free_station.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis.hpp"
#include "point_matching.hpp"
#include "statistics.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/stationing/geometry_verdict.hpp"

namespace versine::stationing {
namespace {

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
    // A levelled instrument's standing axis is up.
    if (options_.tilt_sigma) plumb_ = Plumb{.sigma = *options_.tilt_sigma};
    if (options_.plumb) plumb_ = options_.plumb;
    result_.name = station_.name;
    result_.from = station_.from;
    result_.to = station_.to;
    result_.warnings = station_.warnings;
    auto matching = match_points(station_, network_, options_);
    if (!matching) return tl::unexpected(matching.error());
    search_.used = std::move(matching->used);
    search_.left_out = std::move(matching->left_out);
    search_.adjustment.pose = matching->pose;
    result_.excluded = std::move(matching->excluded);
    result_.warnings.insert(result_.warnings.end(), matching->warnings.begin(), matching->warnings.end());
    if (options_.left_out) take_out();
    if (auto ok = refine(); !ok) return tl::unexpected(ok.error());
    if (!options_.left_out) {
      snoop();
      readmit();
    }
    return finish();
  }

 private:
  /// Everything is used but what is decided to be left out.
  void take_out() {
    auto all = std::move(search_.used);
    all.insert(all.end(), search_.left_out.begin(), search_.left_out.end());
    search_.used.clear(), search_.left_out.clear();
    for (const Candidate& c : all) {
      const auto target = static_cast<std::size_t>(c.target - station_.targets.data());
      const bool out = std::count(options_.left_out->begin(), options_.left_out->end(), target) > 0;
      (out ? search_.left_out : search_.used).push_back(c);
    }
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
                                {options_.solve_scale, plumb_, robust});
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
      return fail(station_error(station_, "targets that lie on a line", "points that span at least a triangle",
                                "use back-sights on both sides of the track, ahead and behind"));
    }
    const auto& a = search_.adjustment;
    if (const auto constant = common_distance_error(search_.observations, a); constant && a.redundancy > 5) {
      return fail(station_error(
          station_,
          fmt::format("all distances {:.1f} mm too {}", std::abs(constant->value) * 1e3,
                      constant->value > 0.0 ? "long" : "short"),
          fmt::format("distances that fit the control points (what is left: {:.1f} sigma)", constant->test),
          "this looks like a prism constant applied twice, or not at all: set prism_constant_mm to what "
          "the instrument has not applied itself"));
    }
    return {};
  }

  /// The worst target goes, one at a time, as long as a test fails and enough remain to tell.
  void snoop() {
    const std::size_t least = plumb_ ? 3 : 4;
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

  bool taken(const ControlPoint* p) const {
    return std::any_of(search_.used.begin(), search_.used.end(), [&](const Candidate& c) { return c.point == p; });
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
  std::optional<Plumb> plumb_;
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
