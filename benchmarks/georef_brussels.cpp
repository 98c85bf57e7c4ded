// SPDX-License-Identifier: Apache-2.0
// The measuring train's logs around Brussels airport: expected paths, fixes hidden for 10 and 30 s, and the same with
// the acceleration's size and correlation time chosen on all other logs. versine_georef_brussels [FOLDER OF DATA]
#include <algorithm>
#include <cstdio>
#include <limits>

#include "support/brussels.hpp"

using namespace versine;
using namespace versine::test;

namespace {

constexpr double windows[] = {10.0, 30.0};

struct Motion {
  double sigma, time;
};
constexpr Motion grid[] = {{0.3, 8},   {0.3, 12}, {0.3, 18},  {0.45, 8}, {0.45, 12},
                           {0.45, 18}, {0.65, 8}, {0.65, 12}, {0.65, 18}};

georef::Options with(const Motion& m) {
  georef::Options o;
  o.without_imu.sigma = m.sigma;
  o.without_imu.time = m.time;
  return o;
}

using PerLog = std::map<std::string, std::map<double, Errors>>;

PerLog errors_of(const Fixture& f, const georef::Options& options) {
  PerLog out;
  for (const auto& [name, ids] : f.expected) {
    if (name == "log_29083") continue;  // its fix types lie: nothing to compare with
    for (const double w : windows) {
      if (!hide(f, f.log(name), ids, w, options, out[name][w])) std::printf("%s: no result\n", name.c_str());
    }
  }
  return out;
}

Errors sum(const PerLog& logs, double window, const std::string& without = "") {
  Errors out;
  for (const auto& [name, errors] : logs) {
    if (name == without) continue;
    const Errors& e = errors.at(window);
    out.square += e.square, out.n += e.n, out.inside += e.inside, out.worst = std::max(out.worst, e.worst);
  }
  return out;
}

void row(const char* what, double window, const Errors& e) {
  std::printf("| %s, %.0f s | %zu | %.3f m | %.2f m | %.1f %% |\n", what, window, e.n, e.rms(), e.worst,
              100.0 * e.coverage());
}

void paths(const Fixture& f) {
  std::printf(
      "| log | expected path | feasible | monotone | probability | paths |\n| --- | --- | --- | --- | --- | --- |\n");
  for (const auto& [name, ids] : f.expected) {
    const auto r = georef::georeference(*f.map, f.log(name), {});
    if (!r) continue;
    bool feasible = true, monotone = true;
    double probability = 1.0;
    std::size_t count = 0;
    for (const auto& j : r->journeys) {
      const auto& best = j.paths.front();
      const auto& path = best.coordinates.path();
      feasible = feasible && network::first_infeasible(f.map->network, path) == path.size();
      monotone = monotone && std::is_sorted(best.motion.distance.begin(), best.motion.distance.end());
      probability *= best.probability;
      count += j.paths.size();
    }
    std::printf("| %s | %s | %s | %s | %.4f | %zu |\n", name.c_str(), ids_of(*f.map, *r) == ids ? "exact" : "WRONG",
                feasible ? "yes" : "NO", monotone ? "yes" : "NO", probability, count);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path data = argc > 1 ? argv[1] : VERSINE_SOURCE "/../shared/data";
  const Fixture f(data / "brussels-airport");
  paths(f);
  std::printf(
      "\n| fixes hidden for | fixes | RMS | worst | 95 %% interval covers |\n| --- | --- | --- | --- | --- |\n");
  const auto defaults = errors_of(f, {});
  for (const double w : windows) row("defaults", w, sum(defaults, w));

  // Leave one log out: the two values of the motion that fit the other logs best judge this one.
  std::vector<PerLog> all;
  for (const auto& m : grid) all.push_back(errors_of(f, with(m)));
  std::map<double, Errors> left;
  for (const auto& [name, errors] : defaults) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double misfit = sum(all[i], 10.0, name).rms() / 0.28 + sum(all[i], 30.0, name).rms() / 3.1;
      if (misfit < least) least = misfit, best = i;
    }
    std::printf("<!-- without %s: %.2f m/s^2, %.0f s -->\n", name.c_str(), grid[best].sigma, grid[best].time);
    for (const double w : windows) {
      const Errors& e = all[best].at(name).at(w);
      auto& l = left[w];
      l.square += e.square, l.n += e.n, l.inside += e.inside, l.worst = std::max(l.worst, e.worst);
    }
  }
  for (const double w : windows) row("chosen on the other logs", w, left[w]);
}
