// SPDX-License-Identifier: Apache-2.0
#include "versine/io/network_labelled.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "file_bytes.hpp"
#include "versine/core/units.hpp"

namespace versine::io {

namespace {

using nlohmann::json;

/// A feature that cannot be understood ends the reading; the caller adds file and record.
struct Fault {
  std::string field, found, expected;
};

std::string text(const json& p, const char* key) {
  const auto it = p.find(key);
  if (it == p.end() || it->is_null()) throw Fault{key, "no such property", "text"};
  return it->is_string() ? it->get<std::string>() : it->dump();
}

double fraction(const json& p, const char* key, double of) {
  const auto it = p.find(key);
  if (it == p.end() || !it->is_number()) throw Fault{key, it == p.end() ? "no such property" : it->dump(), "a number"};
  const double x = it->get<double>() / of;
  if (!(x >= 0.0 && x <= 1.0)) throw Fault{key, it->dump(), fmt::format("a number from 0 to {}", of)};
  return x;
}

int direction(const json& p, const char* key) {
  const std::string word = text(p, key);
  if (word == "0-100") return 1;
  if (word == "100-0") return -1;
  throw Fault{key, "'" + word + "'", "'0-100' or '100-0'"};
}

network::SourceConnection relation(const json& p) {
  network::SourceConnection c;
  c.a = text(p, "netelementA");
  c.b = text(p, "netelementB");
  c.at_a = fraction(p, "positionOnA", 1.0);
  c.at_b = fraction(p, "positionOnB", 1.0);
  const std::string word = text(p, "navigability");
  using N = network::Navigability;
  if (word == "both")
    c.navigability = N::both;
  else if (word == "none")
    c.navigability = N::none;
  else if (word == "AB")
    c.navigability = N::a_to_b;
  else if (word == "BA")
    c.navigability = N::b_to_a;
  else
    throw Fault{"navigability", "'" + word + "'", "'both', 'none', 'AB' or 'BA'"};
  return c;
}

network::SourceConnection connection(const json& p) {
  network::SourceConnection c;
  c.a = text(p, "from");
  c.b = text(p, "to");
  c.direction_a = direction(p, "from_direction");
  c.at_a = c.direction_a > 0 ? 1.0 : 0.0;
  c.direction_b = direction(p, "to_direction");
  c.at_b = fraction(p, "to_percent", 100.0);
  return c;
}

void append_line(const json& coordinates, double unit, std::vector<Eigen::Vector2d>& points) {
  if (!coordinates.is_array()) throw Fault{"coordinates", "no list", "a list of positions"};
  points.reserve(points.size() + coordinates.size());
  for (const auto& c : coordinates) {
    if (!c.is_array() || c.size() < 2 || !c[0].is_number() || !c[1].is_number()) {
      throw Fault{"coordinates", c.dump(), "a position of two or three numbers"};
    }
    points.emplace_back(c[0].get<double>() * unit, c[1].get<double>() * unit);
  }
}

std::string crs_of(const json& root) {
  const auto it = root.find("crs");
  if (it == root.end() || it->is_null()) return "";
  const std::string name = it->value(json::json_pointer("/properties/name"), "");
  if (name.find("CRS84") != std::string::npos) return "";
  const auto at = name.find("EPSG");
  const auto digits = name.find_last_of(':');
  if (at == std::string::npos || digits == std::string::npos) throw Fault{"crs", "'" + name + "'", "an EPSG code"};
  const std::string code = name.substr(digits + 1);
  return code == "4326" ? "" : "EPSG:" + code;
}

void add_feature(const json& feature, std::size_t record, double unit, network::NetworkSource& out) {
  static const json none = json::object();
  const auto it = feature.find("properties");
  const json& p = it != feature.end() && it->is_object() ? *it : none;
  const std::string type = p.contains("type") && p["type"].is_string() ? p["type"].get<std::string>() : "";
  if (type == "netrelation" || type == "connection") {
    out.connections.push_back(type == "connection" ? connection(p) : relation(p));
    out.connections.back().record = record;
    return;
  }
  const auto geometry = feature.find("geometry");
  if (geometry == feature.end() || !geometry->is_object()) return;
  const std::string kind = geometry->value("type", "");
  if (kind != "LineString" && kind != "MultiLineString") return;
  network::SourceTrack track;
  track.id =
      p.contains("id") ? text(p, "id") : (feature.contains("id") ? text(feature, "id") : fmt::format("{}", record));
  track.record = record;
  if (const auto l = p.find("length_m"); l != p.end() && l->is_number()) track.length = l->get<double>();
  const auto& coordinates = geometry->at("coordinates");
  if (kind == "LineString") {
    append_line(coordinates, unit, track.points);
    out.tracks.push_back(std::move(track));
    return;
  }
  for (const auto& part : coordinates) {  // parts are tracks of their own: they need not touch
    network::SourceTrack piece = track;
    piece.id = coordinates.size() == 1 ? track.id : fmt::format("{}.{}", track.id, &part - &coordinates[0] + 1);
    append_line(part, unit, piece.points);
    out.tracks.push_back(std::move(piece));
  }
}

}  // namespace

Expected<network::NetworkSource> read_labelled_network(const std::filesystem::path& path) {
  auto bytes = file_bytes(path);
  if (!bytes) return tl::unexpected(bytes.error());
  const json root = json::parse(*bytes, nullptr, false);
  const auto features = root.is_object() ? root.find("features") : root.end();
  if (root.is_discarded() || !root.is_object() || features == root.end() || !features->is_array()) {
    return fail({.file = path.string(),
                 .found = root.is_discarded() ? "text that is no JSON" : "JSON without features",
                 .expected = "a GeoJSON FeatureCollection",
                 .advice = "export the map as GeoJSON or GeoPackage"});
  }
  network::NetworkSource out;
  out.file = path.string();
  std::size_t record = 0;
  try {
    out.crs = crs_of(root);
    const double unit = out.crs.empty() ? units::deg : 1.0;
    for (const auto& feature : *features) add_feature(feature, ++record, unit, out);
  } catch (const Fault& fault) {
    return fail({.file = out.file,
                 .line = record,
                 .field = fault.field,
                 .found = fault.found,
                 .expected = fault.expected,
                 .advice = "the number is that of the feature in the file, counted from 1"});
  } catch (const json::exception& error) {
    return fail({.file = out.file,
                 .line = record,
                 .found = error.what(),
                 .expected = "a GeoJSON feature",
                 .advice = "the number is that of the feature in the file, counted from 1"});
  }
  return out;
}

}  // namespace versine::io
