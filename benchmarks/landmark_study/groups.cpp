// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "scenario.hpp"
#include "studies.hpp"
#include "versine/core/units.hpp"
#include "versine/simulation/random.hpp"
#include "versine/simulation/world.hpp"

namespace versine::study {

using namespace units;

namespace {

/// One power cycle: 15 minutes of standing, then three times 120 m with landmarks at 0, 60 and 120 m, driven back
/// between them.
simulation::Scenario power_cycle() {
  simulation::Scenario s = jiang_trolley(90 * deg);  // east: the lateral direction is north, as in the paper's table
  s.track.spectrum = simulation::Spectrum::german_low;
  s.motion.start = 20.0;
  s.motion.stand = 900.0;
  for (int group = 0; group < 3; ++group) {
    s.motion.legs.push_back({.to = 140.0, .speed = 1.0, .stop = 30.0, .stop_every = 60.0, .stop_each = 30.0});
    if (group < 2) s.motion.legs.push_back({.to = 20.0, .speed = 1.0, .stop = 30.0});
  }
  return s;
}

}  // namespace

int groups(int seeds) {
  constexpr double calibrated = 0.05e-3;  // rad, what calibration left of each mounting angle
  simulation::Scenario scenario = power_cycle();
  std::vector<std::array<Squares, 6>> all;
  SilentProgress silent;
  for (int seed = 0; seed < seeds; ++seed) {
    std::array<Squares, 6> result;
    simulation::RandomStream mounting(simulation::run_seed(7, std::uint64_t(seed)), "mounting");
    scenario.trolley.mounting = {calibrated * mounting.normal(), calibrated * mounting.normal(),
                                 calibrated * mounting.normal()};
    const auto world = simulation::prepare(scenario);
    if (!world) return fmt::print(stderr, "{}\n", world.error().message()), 1;
    auto options = options_for(scenario);
    options.mounting_sigma = calibrated;
    for (int cycle = 0; cycle < 2; ++cycle) {
      const auto r = simulation::observe(**world, simulation::run_seed(7, std::uint64_t(2 * seed + cycle)));
      Series<sensors::LandmarkSample> landmarks;
      landmarks.samples = r.landmarks;
      const auto solved = fusion::run_landmark_dead_reckoning({&r.imu, &r.odometers[0], &landmarks}, options, silent);
      if (!solved) return fmt::print(stderr, "{}\n", solved.error().message()), 1;
      // Every 3 m of each way out.
      std::size_t group = 3 * std::size_t(cycle);
      bool out = false;
      double next = 20.0;
      for (std::size_t i = 0; i < r.truth.progress.size(); ++i) {
        const auto& p = r.truth.progress[i];
        if (p.speed < 0.0 && out) {
          out = false;
          next = 20.0;
          ++group;
        }
        if (!(p.speed > 0.0) || p.distance < next) continue;
        out = true;
        next += 3.0;
        Eigen::Vector3d e;
        Eigen::Matrix3d P;
        if (error_at(solved->solution.smoothed, r.truth.trajectory[i], e, P)) result[group].add(e, P);
      }
    }
    all.push_back(result);
  }
  const auto table = [&](const char* title, const auto& value) {
    fmt::print(
        "\n{}\n\n| RMS, mm | group 1 | group 2 | group 3 | group 4 | group 5 | group 6 "
        "|\n|---|---|---|---|---|---|---|\n",
        title);
    const std::pair<const char*, int> rows[] = {{"north", 0}, {"vertical", 2}, {"east", 1}};
    for (const auto& [name, axis] : rows) {
      fmt::print("| {} |", name);
      for (std::size_t g = 0; g < 6; ++g) fmt::print(" {:.3f} |", value(g, axis) / mm);
      fmt::print("\n");
    }
  };
  table("First seed", [&](std::size_t g, int axis) { return all[0][g].rms()[axis]; });
  table(fmt::format("RMS over {} seeds", seeds).c_str(), [&](std::size_t g, int axis) {
    double sum = 0.0;
    for (const auto& r : all) sum += std::pow(r[g].rms()[axis], 2);
    return std::sqrt(sum / double(all.size()));
  });
  table(fmt::format("Largest of {} seeds", seeds).c_str(), [&](std::size_t g, int axis) {
    double worst = 0.0;
    for (const auto& r : all) worst = std::max(worst, double(r[g].rms()[axis]));
    return worst;
  });
  Eigen::Array3d inside = Eigen::Array3d::Zero(), normalised = Eigen::Array3d::Zero();
  double count = 0.0, groups_above = 0.0;
  for (const auto& r : all) {
    for (const auto& g : r) {
      inside += g.inside;
      normalised += g.normalised;
      count += g.count;
      groups_above += g.rms().maxCoeff() > 1.0 * mm ? 1 : 0;
    }
  }
  fmt::print(
      "\ninside 1.96 sigma: north {:.1f} %, east {:.1f} %, vertical {:.1f} %; mean squared error over variance {:.2f} "
      "{:.2f} {:.2f}\ngroups above 1 mm in any direction: {} of {}\n",
      100 * inside[0] / count, 100 * inside[1] / count, 100 * inside[2] / count, normalised[0] / count,
      normalised[1] / count, normalised[2] / count, groups_above, 6 * all.size());
  return 0;
}

}  // namespace versine::study
