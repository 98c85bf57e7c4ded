// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "command.hpp"
#include "versine/core/units.hpp"
#include "versine/io/network_file.hpp"
#include "versine/network/build.hpp"
#include "versine/network/check.hpp"

namespace versine::cli {

namespace {

struct NetworkOptions {
  io::NetworkFile file;
  std::string geojson;
  bool quiet = false, json = false;
};

/// Findings as points, for a geographic information system.
Expected<void> write_geojson(const std::string& path, const network::Network& n, const network::MapCheck& c) {
  nlohmann::ordered_json features = nlohmann::ordered_json::array();
  for (const auto& f : c.findings) {
    const auto g = n.to_geodetic(f.place);
    features.push_back(
        {{"type", "Feature"},
         {"properties", {{"kind", f.kind}, {"track", f.track}, {"value", f.value}}},
         {"geometry", {{"type", "Point"}, {"coordinates", {g.longitude / units::deg, g.latitude / units::deg}}}}});
  }
  std::ofstream stream(path);
  const nlohmann::ordered_json all{{"type", "FeatureCollection"}, {"features", std::move(features)}};
  if ((stream << all.dump() << '\n').flush()) return {};
  return fail({.file = path,
               .found = "that it cannot be written",
               .expected = "a writable place with free space",
               .advice = "check permissions and free space"});
}

std::string summary_json(const network::Network& n, const network::MapCheck& c,
                         const std::map<std::string, std::size_t>& kinds) {
  return nlohmann::ordered_json{{"tracks", n.tracks.size()},    {"length_m", c.length}, {"joints", n.joints.size()},
                                {"switches", c.switches},       {"pieces", c.pieces},   {"findings", kinds},
                                {"warnings", n.record.warnings}}
      .dump(2);
}

/// Counts by kind, then every finding with its place.
int check_map(const NetworkOptions& o) {
  const auto source = io::read_network(o.file);
  if (!source) return report(source.error());
  const auto n = network::build(*source);
  if (!n) return report(n.error());
  const auto c = network::check(*n);
  std::map<std::string, std::size_t> kinds;
  for (const auto& f : c.findings) ++kinds[f.kind];
  if (!o.geojson.empty()) {
    if (auto done = write_geojson(o.geojson, *n, c); !done) return report(done.error());
  }
  if (o.json) {
    std::printf("%s\n", summary_json(*n, c, kinds).c_str());
    return good;
  }
  std::printf("%zu tracks, %.1f km, %zu joints, %zu switches, %zu connected pieces\n", n->tracks.size(),
              c.length / 1000.0, n->joints.size(), c.switches, c.pieces);
  for (const auto& w : n->record.warnings) std::printf("%s\n", w.c_str());
  for (const auto& [kind, count] : kinds) std::printf("%8zu  %s\n", count, kind.c_str());
  if (o.quiet) return good;
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
  const auto options = std::make_shared<NetworkOptions>();
  sub->add_option("file", options->file.path, "Map: GeoPackage, GeoJSON, Shapefile, OpenStreetMap")->required();
  sub->add_option("--layer", options->file.layer, "Layer of the tracks");
  sub->add_option("--crs", options->file.source_crs, "CRS of the file, when it does not tell it");
  sub->add_option("--osm-types", options->file.osm_types, "Values of OpenStreetMap's railway tag")->delimiter(',');
  sub->add_option("--geojson", options->geojson, "Also write the findings as points");
  sub->add_flag("--json", options->json, "Print the counts as JSON");
  sub->add_flag("--quiet", options->quiet, "Only the counts");
  sub->callback([options, &exit] { exit = check_map(*options); });
}

}  // namespace versine::cli
