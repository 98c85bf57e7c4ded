// SPDX-License-Identifier: Apache-2.0
#include "versine/app/compare.hpp"

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "versine/core/units.hpp"
#include "versine/io/read_recording.hpp"

namespace versine::cli {

namespace {
struct CompareOptions {
  std::string trajectory, reference;
  double margin_s = 0.0;
  bool json = false;
};

/// A trajectory file, or the one inside a result folder.
Expected<geodesy::Trajectory> load(const std::string& name) {
  std::filesystem::path path = name;
  if (std::filesystem::is_directory(path)) path /= "trajectory.h5";
  auto read = io::read_trajectory({.table = {.path = path}});
  if (!read) return tl::unexpected(read.error());
  return std::move(read->series);
}

int compare(const CompareOptions& o) {
  const auto trajectory = load(o.trajectory);
  if (!trajectory) return report(trajectory.error());
  const auto reference = load(o.reference);
  if (!reference) return report(reference.error());
  const auto c = app::compare_trajectories(*trajectory, *reference, o.margin_s);
  if (!c) return report(c.error());
  const struct {
    const char* name;
    const char* unit;
    double scale;
    const app::DifferenceStatistics& s;
  } rows[] = {{"along", "mm", units::mm, c->along},
              {"across", "mm", units::mm, c->across},
              {"up", "mm", units::mm, c->up},
              {"roll", "arcsec", units::arcsec, c->roll},
              {"pitch", "arcsec", units::arcsec, c->pitch},
              {"heading", "arcsec", units::arcsec, c->heading}};
  nlohmann::ordered_json out{{"points", c->points}};
  if (!o.json)
    std::printf("%zu points\n%-8s %12s %12s %12s %12s\n", c->points, "", "RMS", "95 %", "largest", "in 1.96 s");
  for (const auto& [name, unit, scale, s] : rows) {
    out[name] = {{"unit", unit},         {"rms", s.rms / scale},     {"p95", s.p95 / scale},
                 {"max", s.max / scale}, {"coverage95", s.coverage}, {"rms_in_sigmas", s.in_sigmas}};
    if (!o.json) {
      std::printf("%-8s %12.3f %12.3f %12.3f %10.1f %%  (%s)\n", name, s.rms / scale, s.p95 / scale, s.max / scale,
                  100.0 * s.coverage, unit);
    }
  }
  if (o.json) std::printf("%s\n", out.dump(2).c_str());
  return good;
}
}  // namespace

void add_compare(CLI::App& app, int& exit) {
  auto* command =
      app.add_subcommand("compare", "Compare a trajectory with another run's or with the simulator's truth");
  auto o = std::make_shared<CompareOptions>();
  command->add_option("trajectory", o->trajectory, "Result folder or trajectory file (.h5, .csv)")->required();
  command->add_option("reference", o->reference, "Result folder or trajectory file to compare with")->required();
  command->add_option("--margin", o->margin_s, "Leave out this many seconds at both ends")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--json", o->json, "Print as JSON");
  command->callback([o, &exit] { exit = compare(*o); });
}

}  // namespace versine::cli
