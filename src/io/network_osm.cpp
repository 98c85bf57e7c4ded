// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <osmium/handler.hpp>
#include <osmium/io/any_input.hpp>
#include <osmium/visitor.hpp>
#include <unordered_map>

#include "versine/core/units.hpp"
#include "versine/io/network_file.hpp"

namespace versine::io {

namespace {

struct Way {
  osmium::object_id_type id;
  std::vector<osmium::object_id_type> nodes;
};

/// First the ways, with the nodes that they need; then those nodes. Extracts of railways are small: both fit.
struct Ways : osmium::handler::Handler {
  const std::vector<std::string>& types;
  std::vector<Way> ways;
  explicit Ways(const std::vector<std::string>& t) : types(t) {}
  void way(const osmium::Way& w) {
    const char* type = w.tags()["railway"];
    if (type == nullptr || std::find(types.begin(), types.end(), type) == types.end()) return;
    Way out{w.id(), {}};
    for (const auto& n : w.nodes()) out.nodes.push_back(n.ref());
    ways.push_back(std::move(out));
  }
};

struct Nodes : osmium::handler::Handler {
  std::unordered_map<osmium::object_id_type, Eigen::Vector2d>& places;
  std::vector<network::SourceNode>& marked;
  Nodes(std::unordered_map<osmium::object_id_type, Eigen::Vector2d>& p, std::vector<network::SourceNode>& m)
      : places(p), marked(m) {}
  void node(const osmium::Node& n) {
    const auto it = places.find(n.id());
    if (it == places.end() || !n.location().valid()) return;
    it->second = {n.location().lon() * units::deg, n.location().lat() * units::deg};
    const char* type = n.tags()["railway"];
    if (type == nullptr) return;
    using K = network::NodeKind;
    const std::string_view kind = type;
    const char* form = n.tags()["railway:switch"];
    if (kind == "railway_crossing") marked.push_back({it->second, K::crossing});
    if (kind == "buffer_stop") marked.push_back({it->second, K::buffer_stop});
    if (kind == "switch") {
      const bool slip = form != nullptr && std::string_view(form).find("slip") != std::string_view::npos;
      marked.push_back({it->second, slip ? K::slip : K::switch_});
    }
  }
};

}  // namespace

Expected<network::NetworkSource> read_osm_network(const NetworkFile& file) {
  network::NetworkSource out;
  out.file = file.path.string();
  out.share_inner_vertices = true;
  try {
    Ways ways(file.osm_types);
    {
      osmium::io::Reader reader(out.file, osmium::osm_entity_bits::way);
      osmium::apply(reader, ways);
      reader.close();
    }
    std::unordered_map<osmium::object_id_type, Eigen::Vector2d> places;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& w : ways.ways) {
      for (const auto n : w.nodes) places.try_emplace(n, nan, nan);
    }
    Nodes nodes(places, out.nodes);
    osmium::io::Reader reader(out.file, osmium::osm_entity_bits::node);
    osmium::apply(reader, nodes);
    reader.close();
    for (const auto& w : ways.ways) {
      network::SourceTrack t;
      t.id = std::to_string(w.id);
      t.record = out.tracks.size() + 1;
      for (const auto n : w.nodes) {
        const Eigen::Vector2d& p = places[n];
        if (p.allFinite()) t.points.push_back(p);  // an extract may cut a way
      }
      out.tracks.push_back(std::move(t));
    }
  } catch (const std::exception& error) {
    return fail({.file = out.file,
                 .found = error.what(),
                 .expected = "an OpenStreetMap file (PBF or XML)",
                 .advice = "check the path, or download the extract again"});
  }
  if (out.tracks.empty()) {
    return fail({.file = out.file,
                 .field = "railway",
                 .found = "no way of these types",
                 .expected = fmt::format("ways with railway = {}", fmt::join(file.osm_types, ", ")),
                 .advice = "name the types to be read in network.osm_types"});
  }
  return out;
}

}  // namespace versine::io
