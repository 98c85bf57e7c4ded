// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <memory>

#include "versine/core/units.hpp"
#include "versine/io/network_file.hpp"
#include "versine/io/network_labelled.hpp"

namespace versine::io {

namespace {

void append(const OGRLineString& line, double unit, network::SourceTrack track, int part, network::NetworkSource& out) {
  if (part > 0) track.id += fmt::format(".{}", part);
  track.points.reserve(static_cast<std::size_t>(line.getNumPoints()));
  for (int i = 0; i < line.getNumPoints(); ++i) track.points.emplace_back(line.getX(i) * unit, line.getY(i) * unit);
  out.tracks.push_back(std::move(track));
}

/// The CRS as text for PROJ; empty for longitude and latitude. None: the layer does not tell.
std::optional<std::string> crs_of(OGRLayer& layer) {
  const OGRSpatialReference* s = layer.GetSpatialRef();
  if (s == nullptr) return std::nullopt;
  if (s->IsGeographic() != 0) return "";
  const char *name = s->GetAuthorityName(nullptr), *code = s->GetAuthorityCode(nullptr);
  if (name != nullptr && code != nullptr) return fmt::format("{}:{}", name, code);
  char* wkt = nullptr;
  s->exportToWkt(&wkt);
  std::string text = wkt;
  CPLFree(wkt);
  return text;
}

int id_field(OGRLayer& layer, const std::string& wanted) {
  auto* def = layer.GetLayerDefn();
  if (!wanted.empty()) return def->GetFieldIndex(wanted.c_str());
  for (const char* name : {"id", "track_id", "name"}) {
    if (const int i = def->GetFieldIndex(name); i >= 0) return i;
  }
  return -1;
}

}  // namespace

Expected<network::NetworkSource> read_gdal_network(const NetworkFile& file) {
  GDALAllRegister();
  CPLPushErrorHandler(CPLQuietErrorHandler);
  const std::unique_ptr<GDALDataset, void (*)(GDALDataset*)> set(
      GDALDataset::Open(file.path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY), [](GDALDataset* d) { GDALClose(d); });
  CPLPopErrorHandler();
  network::NetworkSource out;
  out.file = file.path.string();
  if (!set) {
    return fail({.file = out.file,
                 .found = "a file that GDAL cannot read",
                 .expected = "GeoPackage, Shapefile or GeoJSON",
                 .advice = "check the path; a Shapefile needs its .shx and .dbf beside it"});
  }
  OGRLayer* layer = nullptr;
  for (int i = 0; i < set->GetLayerCount() && layer == nullptr; ++i) {
    OGRLayer* l = set->GetLayer(i);
    const auto type = wkbFlatten(l->GetGeomType());
    const bool lines = type == wkbLineString || type == wkbMultiLineString || type == wkbUnknown;
    if (file.layer.empty() ? lines : file.layer == l->GetName()) layer = l;
  }
  if (layer == nullptr) {
    return fail({.file = out.file,
                 .field = "network.layer",
                 .found = file.layer.empty() ? "no layer of lines" : "no layer '" + file.layer + "'",
                 .expected = "a layer of tracks as lines",
                 .advice = "name the layer as ogrinfo lists it"});
  }
  const int field = id_field(*layer, file.id_field);
  if (field < 0 && !file.id_field.empty()) {
    return fail({.file = out.file,
                 .field = file.id_field,
                 .found = "no such attribute",
                 .expected = "an attribute that names each track",
                 .advice = "leave network.id_field out to number the tracks"});
  }
  const auto crs =
      file.source_crs.empty() ? crs_of(*layer) : std::optional(file.source_crs == "EPSG:4326" ? "" : file.source_crs);
  OGREnvelope extent;
  if (layer->GetExtent(&extent) != OGRERR_NONE) extent = {};
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
  for (const auto& feature : *layer) {
    network::SourceTrack track;
    track.record = ++record;
    track.id = field >= 0 && feature->IsFieldSetAndNotNull(field) != 0 ? feature->GetFieldAsString(field)
                                                                       : std::to_string(record);
    const OGRGeometry* g = feature->GetGeometryRef();
    if (g == nullptr) continue;
    const auto type = wkbFlatten(g->getGeometryType());
    if (type == wkbLineString) append(*g->toLineString(), unit, track, 0, out);
    if (type == wkbMultiLineString) {
      const auto* multi = g->toMultiLineString();
      for (int i = 0; i < multi->getNumGeometries(); ++i) {
        append(*multi->getGeometryRef(i), unit, track, multi->getNumGeometries() > 1 ? i + 1 : 0, out);
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
