// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <map>
#include <memory>
#include <string>

#include "command.hpp"
#include "versine/core/units.hpp"
#include "versine/io/network_file.hpp"
#include "versine/network/build.hpp"
#include "versine/network/check.hpp"

namespace versine::cli {

namespace {

/// Table by kind, then every finding with its place.
int check_map(const io::NetworkFile& file, bool quiet) {
  const auto source = io::read_network(file);
  if (!source) return report(source.error());
  const auto n = network::build(*source);
  if (!n) return report(n.error());
  const auto c = network::check(*n);
  std::map<std::string, std::size_t> kinds;
  for (const auto& f : c.findings) ++kinds[f.kind];
  std::printf("%zu tracks, %.1f km, %zu joints, %zu switches, %zu connected pieces\n", n->tracks.size(),
              c.length / 1000.0, n->joints.size(), c.switches, c.pieces);
  for (const auto& w : n->record.warnings) std::printf("%s\n", w.c_str());
  for (const auto& [kind, count] : kinds) std::printf("%8zu  %s\n", count, kind.c_str());
  if (quiet) return good;
  std::printf("kind,track,latitude_deg,longitude_deg,value\n");
  for (const auto& f : c.findings) {
    const auto g = n->to_geodetic(f.place);
    std::printf("%s,%s,%.7f,%.7f,%.3f\n", f.kind.c_str(), f.track.c_str(), g.latitude / units::deg,
                g.longitude / units::deg, f.value);
  }
  return good;
}

}  // namespace

void add_network(CLI::App& app, int& exit) {
  auto* command = app.add_subcommand("network", "Railway maps");
  command->require_subcommand(1);
  auto* sub = command->add_subcommand("check", "List what is doubtful in a map");
  const auto file = std::make_shared<io::NetworkFile>();
  const auto quiet = std::make_shared<bool>(false);
  sub->add_option("file", file->path, "Map: GeoPackage, GeoJSON, Shapefile, OpenStreetMap")->required();
  sub->add_option("--layer", file->layer, "Layer of the tracks");
  sub->add_option("--crs", file->source_crs, "CRS of the file, when it does not tell it");
  sub->add_flag("--quiet", *quiet, "Only the counts");
  sub->callback([file, quiet, &exit] { exit = check_map(*file, *quiet); });
}

}  // namespace versine::cli
