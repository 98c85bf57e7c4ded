// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "gdal.hpp"
#include "versine/core/units.hpp"
#include "versine/io/network_file.hpp"
#include "versine/io/network_labelled.hpp"

namespace versine::io {

namespace {

void append(const Gdal& g, OGRGeometryH line, double unit, network::SourceTrack track, int part,
            network::NetworkSource& out) {
  if (part > 0) track.id += fmt::format(".{}", part);
  const int count = g.OGR_G_GetPointCount(line);
  track.points.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) track.points.emplace_back(g.OGR_G_GetX(line, i) * unit, g.OGR_G_GetY(line, i) * unit);
  out.tracks.push_back(std::move(track));
}

/// The CRS as text for PROJ; empty for longitude and latitude. None: the layer does not tell.
std::optional<std::string> crs_of(const Gdal& g, OGRLayerH layer) {
  OGRSpatialReferenceH s = g.OGR_L_GetSpatialRef(layer);
  if (s == nullptr) return std::nullopt;
  if (g.OSRIsGeographic(s) != 0) return "";
  const char *name = g.OSRGetAuthorityName(s, nullptr), *code = g.OSRGetAuthorityCode(s, nullptr);
  if (name != nullptr && code != nullptr) return fmt::format("{}:{}", name, code);
  char* wkt = nullptr;
  g.OSRExportToWkt(s, &wkt);
  std::string text = wkt;
  g.VSIFree(wkt);
  return text;
}

int id_field(const Gdal& g, OGRLayerH layer, const std::string& wanted) {
  OGRFeatureDefnH def = g.OGR_L_GetLayerDefn(layer);
  if (!wanted.empty()) return g.OGR_FD_GetFieldIndex(def, wanted.c_str());
  for (const char* name : {"id", "track_id", "name"}) {
    if (const int i = g.OGR_FD_GetFieldIndex(def, name); i >= 0) return i;
  }
  return -1;
}

/// The layer of this name, or the first that may hold lines; null when there is none.
OGRLayerH find_layer(const Gdal& g, GDALDatasetH set, const std::string& wanted) {
  for (int i = 0; i < g.GDALDatasetGetLayerCount(set); ++i) {
    OGRLayerH layer = g.GDALDatasetGetLayer(set, i);
    const auto type = g.OGR_GT_Flatten(g.OGR_L_GetGeomType(layer));
    const bool lines = type == wkbLineString || type == wkbMultiLineString || type == wkbUnknown;
    if (wanted.empty() ? lines : wanted == g.OGR_L_GetName(layer)) return layer;
  }
  return nullptr;
}

}  // namespace

Expected<network::NetworkSource> read_gdal_network(const NetworkFile& file) {
  const auto api = gdal(GdalDrivers::all);
  if (!api) return tl::unexpected(api.error());
  const Gdal& g = **api;
  g.CPLPushErrorHandler(g.CPLQuietErrorHandler);
  const auto set = owned<GdalDataset>(
      g, g.GDALOpenEx(file.path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
  g.CPLPopErrorHandler();
  network::NetworkSource out;
  out.file = file.path.string();
  if (!set) {
    return fail({.file = out.file,
                 .found = "a file that GDAL cannot read",
                 .expected = "GeoPackage, Shapefile or GeoJSON",
                 .advice = "check the path; a Shapefile needs its .shx and .dbf beside it"});
  }
  OGRLayerH layer = find_layer(g, set.get(), file.layer);
  if (layer == nullptr) {
    return fail({.file = out.file,
                 .field = "network.layer",
                 .found = file.layer.empty() ? "no layer of lines" : "no layer '" + file.layer + "'",
                 .expected = "a layer of tracks as lines",
                 .advice = "name the layer as ogrinfo lists it"});
  }
  const int field = id_field(g, layer, file.id_field);
  if (field < 0 && !file.id_field.empty()) {
    return fail({.file = out.file,
                 .field = file.id_field,
                 .found = "no such attribute",
                 .expected = "an attribute that names each track",
                 .advice = "leave network.id_field out to number the tracks"});
  }
  const auto crs =
      file.source_crs.empty() ? crs_of(g, layer) : std::optional(file.source_crs == "EPSG:4326" ? "" : file.source_crs);
  OGREnvelope extent;
  if (g.OGR_L_GetExtent(layer, &extent, TRUE) != OGRERR_NONE) extent = {};
  if (!crs && extent.MinX >= -180.0 && extent.MaxX <= 180.0 && extent.MinY >= -90.0 && extent.MaxY <= 90.0) {
    return fail({.file = out.file,
                 .field = "crs",
                 .found = "coordinates that look like degrees, without a CRS",
                 .expected = "a CRS",
                 .advice = "set network.source_crs = \"EPSG:4326\" if they are WGS84 longitude and latitude"});
  }
  if (!crs) {
    return fail({.file = out.file,
                 .field = "crs",
                 .found = "no CRS",
                 .expected = "a projected CRS",
                 .advice = "set network.source_crs, for example \"EPSG:25832\""});
  }
  out.crs = *crs;
  const double unit = out.crs.empty() ? units::deg : 1.0;
  std::size_t record = 0;
  g.OGR_L_ResetReading(layer);
  while (const auto feature = owned<GdalFeature>(g, g.OGR_L_GetNextFeature(layer))) {
    network::SourceTrack track;
    track.record = ++record;
    track.id = field >= 0 && g.OGR_F_IsFieldSetAndNotNull(feature.get(), field) != 0
                   ? g.OGR_F_GetFieldAsString(feature.get(), field)
                   : std::to_string(record);
    OGRGeometryH shape = g.OGR_F_GetGeometryRef(feature.get());
    if (shape == nullptr) continue;
    const auto type = g.OGR_GT_Flatten(g.OGR_G_GetGeometryType(shape));
    if (type == wkbLineString) append(g, shape, unit, track, 0, out);
    if (type == wkbMultiLineString) {
      const int parts = g.OGR_G_GetGeometryCount(shape);
      for (int i = 0; i < parts; ++i) {
        append(g, g.OGR_G_GetGeometryRef(shape, i), unit, track, parts > 1 ? i + 1 : 0, out);
      }
    }
  }
  return out;
}

Expected<network::NetworkSource> read_network(const NetworkFile& file) {
  const std::string name = file.path.filename().string();
  const auto has = [&](std::string_view ending) { return name.find(ending) != std::string::npos; };
  if (has(".osm") || has(".pbf")) return read_osm_network(file);
  if (has(".geojson") || has(".json")) {
    auto source = read_labelled_network(file.path);
    if (source && !file.source_crs.empty() && file.source_crs != "EPSG:4326") source->crs = file.source_crs;
    return source;
  }
  return read_gdal_network(file);
}

}  // namespace versine::io
