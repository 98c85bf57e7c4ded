// SPDX-License-Identifier: Apache-2.0
#include "versine/io/geometry_gis.hpp"

#include <cmath>

#include "gdal.hpp"
#include "versine/geodesy/projection.hpp"

namespace versine::io {
namespace {

Expected<void> refuse(const Gdal& gdal, const std::filesystem::path& path) {
  return fail({.file = path.string(),
               .found = "a file that cannot be written",
               .expected = "a writable folder with space",
               .advice = gdal.CPLGetLastErrorMsg()});
}

/// A layer that is being written. Owned by its file.
struct Layer {
  const Gdal& gis;
  OGRLayerH handle;

  [[nodiscard]] bool add_field(const std::string& name, OGRFieldType type) const {
    return add_gdal_field(gis, handle, name.c_str(), type);
  }
  [[nodiscard]] GdalFeature feature() const {
    return owned<GdalFeature>(gis, gis.OGR_F_Create(gis.OGR_L_GetLayerDefn(handle)));
  }
  [[nodiscard]] bool put(const GdalFeature& f) const { return gis.OGR_L_CreateFeature(handle, f.get()) == OGRERR_NONE; }
};

GdalGeometry point_at(const Gdal& gdal, double e, double n) {
  auto point = owned<GdalGeometry>(gdal, gdal.OGR_G_CreateGeometry(wkbPoint));
  gdal.OGR_G_AddPoint_2D(point.get(), e, n);
  return point;
}

/// A line of the geometry: its columns by stem ("axis", "left", "right").
struct Line {
  const char* name;
  const track::Column *easting, *northing, *height;
};

std::vector<Line> lines_of(const track::Geometry& g) {
  std::vector<Line> out;
  for (const char* name : {"axis", "left", "right"}) {
    const std::string n = name;
    const Line line{name, g.find("easting_" + n), g.find("northing_" + n), g.find("height_" + n)};
    if (line.easting != nullptr && line.northing != nullptr && line.height != nullptr) out.push_back(line);
  }
  return out;
}

std::size_t stride_of(const track::Geometry& g, const GisOptions& o) {
  return g.step > 0.0 ? std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(o.interval / g.step))) : 1;
}

/// Line strings of a line, one a piece between gaps; `use` gets each.
template <class Use>
bool each_piece(const Gdal& gdal, const track::Geometry& g, const Line& line, std::size_t stride, const Use& use) {
  const auto piece = owned<GdalGeometry>(gdal, gdal.OGR_G_CreateGeometry(wkbLineString));
  const auto finish = [&] {
    const bool good = gdal.OGR_G_GetPointCount(piece.get()) < 2 || use(piece.get());
    gdal.OGR_G_Empty(piece.get());
    return good;
  };
  for (std::size_t i = 0; i < g.size(); ++i) {
    const bool last = i + 1 == g.size();
    if (i % stride != 0 && !last) continue;
    const double e = line.easting->value[i], n = line.northing->value[i], h = line.height->value[i];
    if (std::isfinite(e) && std::isfinite(h))
      gdal.OGR_G_AddPoint(piece.get(), e, n, h);
    else if (!finish())
      return false;
  }
  return finish();
}

bool write_lines(const Gdal& gdal, GDALDatasetH set, OGRSpatialReferenceH crs, const track::Geometry& g,
                 std::size_t stride) {
  for (const char* layer_name : {"axis", "rails"}) {
    const Layer layer{gdal, gdal.GDALDatasetCreateLayer(set, layer_name, crs, wkbLineString25D, nullptr)};
    if (layer.handle == nullptr || !layer.add_field("rail", OFTString)) return false;
    for (const Line& line : lines_of(g)) {
      if ((std::string_view(line.name) == "axis") != (std::string_view(layer_name) == "axis")) continue;
      const bool good = each_piece(gdal, g, line, stride, [&](OGRGeometryH piece) {
        const GdalFeature f = layer.feature();
        gdal.OGR_F_SetFieldString(f.get(), 0, line.name);
        gdal.OGR_F_SetGeometry(f.get(), piece);
        return layer.put(f);
      });
      if (!good) return false;
    }
  }
  return true;
}

/// What a map asks for; everything else is in the tables.
bool wanted(const track::Column& c) {
  const std::string& n = c.name;
  return n == "gauge" || n.starts_with("cross_level") || n.starts_with("twist_") || n.starts_with("deviation_") ||
         n.ends_with("_d1") || n == "curvature" || n == "gradient";
}

bool write_points(const Gdal& gdal, GDALDatasetH set, OGRSpatialReferenceH crs, const track::Geometry& g,
                  std::size_t stride) {
  const auto lines = lines_of(g);
  if (lines.empty()) return true;
  const Line& axis = lines.front();
  const Layer layer{gdal, gdal.GDALDatasetCreateLayer(set, "points", crs, wkbPoint25D, nullptr)};
  if (layer.handle == nullptr || !layer.add_field("mileage_m", OFTReal) || !layer.add_field("flags", OFTInteger))
    return false;
  std::vector<const track::Column*> columns;
  for (const track::Column& c : g.columns) {
    if (wanted(c) && layer.add_field(c.heading(), OFTReal)) columns.push_back(&c);
  }
  const GdalFeature f = layer.feature();
  const auto point = owned<GdalGeometry>(gdal, gdal.OGR_G_CreateGeometry(wkbPoint));
  for (std::size_t i = 0; i < g.size(); i += stride) {
    const double e = axis.easting->value[i], n = axis.northing->value[i], h = axis.height->value[i];
    if (!std::isfinite(e)) continue;
    gdal.OGR_F_SetFID(f.get(), OGRNullFID);
    gdal.OGR_F_SetFieldDouble(f.get(), 0, g.posted_at(g.mileage[i]));
    gdal.OGR_F_SetFieldInteger(f.get(), 1, static_cast<int>(g.flags[i]));
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const double v = columns[k]->value[i] / columns[k]->scale;
      if (std::isfinite(v))
        gdal.OGR_F_SetFieldDouble(f.get(), static_cast<int>(k) + 2, v);
      else
        gdal.OGR_F_SetFieldNull(f.get(), static_cast<int>(k) + 2);
    }
    gdal.OGR_G_SetPoint(point.get(), 0, e, n, h);
    gdal.OGR_F_SetGeometry(f.get(), point.get());
    if (!layer.put(f)) return false;
  }
  return true;
}

bool write_exceedances(const Gdal& gdal, GDALDatasetH set, OGRSpatialReferenceH crs, const track::Geometry& g,
                       const track::Quality& q) {
  const Layer layer{gdal, gdal.GDALDatasetCreateLayer(set, "exceedances", crs, wkbPoint, nullptr)};
  if (layer.handle == nullptr) return false;
  for (const auto& [name, type] :
       std::initializer_list<std::pair<const char*, OGRFieldType>>{{"column", OFTString},
                                                                   {"level", OFTString},
                                                                   {"unit", OFTString},
                                                                   {"value", OFTReal},
                                                                   {"limit", OFTReal},
                                                                   {"sigma", OFTReal},
                                                                   {"probability_over", OFTReal},
                                                                   {"start_m", OFTReal},
                                                                   {"end_m", OFTReal},
                                                                   {"peak_m", OFTReal}}) {
    if (!layer.add_field(name, type)) return false;
  }
  const auto lines = lines_of(g);
  for (const track::Exceedance& x : q.exceedances) {
    const track::Column& c = g.at(x.column);
    const GdalFeature f = layer.feature();
    gdal.OGR_F_SetFieldString(f.get(), 0, x.column.c_str());
    gdal.OGR_F_SetFieldString(f.get(), 1, x.level.c_str());
    gdal.OGR_F_SetFieldString(f.get(), 2, c.unit.c_str());
    const double numbers[] = {x.value / c.scale,    x.limit / c.scale,  x.sigma / c.scale,  x.probability,
                              g.posted_at(x.start), g.posted_at(x.end), g.posted_at(x.peak)};
    for (int k = 0; k < 7; ++k) {
      if (std::isfinite(numbers[k])) gdal.OGR_F_SetFieldDouble(f.get(), k + 3, numbers[k]);
    }
    if (!lines.empty() && std::isfinite(lines.front().easting->value[x.index])) {
      const auto peak = point_at(gdal, lines.front().easting->value[x.index], lines.front().northing->value[x.index]);
      gdal.OGR_F_SetGeometry(f.get(), peak.get());
    }
    if (!layer.put(f)) return false;
  }
  return true;
}

}  // namespace

Expected<void> write_geometry_gpkg(const std::filesystem::path& path, const track::Geometry& g,
                                   const track::Quality* quality, const GisOptions& options) {
  const auto api = gdal(GdalDrivers::geopackage);
  if (!api) return tl::unexpected(api.error());
  const Gdal& gis = **api;
  const GdalDataset set = create_gdal_file(gis, "GPKG", path.c_str());
  if (set == nullptr) return refuse(gis, path);
  const auto projection = geodesy::Projection::create(g.crs);
  if (!projection) return tl::unexpected(projection.error());
  const GdalCrs crs = make_gdal_crs(gis, g.own_grid ? nullptr : projection->wkt().c_str());
  const std::size_t stride = stride_of(g, options);
  const bool good = gis.GDALDatasetStartTransaction(set.get(), FALSE) == OGRERR_NONE &&
                    write_lines(gis, set.get(), crs.get(), g, stride) &&
                    write_points(gis, set.get(), crs.get(), g, stride) &&
                    (quality == nullptr || write_exceedances(gis, set.get(), crs.get(), g, *quality)) &&
                    gis.GDALDatasetCommitTransaction(set.get()) == OGRERR_NONE;
  if (!good) return refuse(gis, path);
  return {};
}

Expected<void> write_geometry_dxf(const std::filesystem::path& path, const track::Geometry& g,
                                  const track::Quality* quality, const GisOptions& options) {
  const auto api = gdal(GdalDrivers::dxf);
  if (!api) return tl::unexpected(api.error());
  const Gdal& gis = **api;
  const GdalDataset set = create_gdal_file(gis, "DXF", path.c_str());
  const Layer layer{
      gis, set == nullptr ? nullptr : gis.GDALDatasetCreateLayer(set.get(), "entities", nullptr, wkbUnknown, nullptr)};
  if (layer.handle == nullptr) return refuse(gis, path);
  const int name = gis.OGR_FD_GetFieldIndex(gis.OGR_L_GetLayerDefn(layer.handle), "Layer");
  const auto put = [&](const char* where, OGRGeometryH shape) {
    const GdalFeature f = layer.feature();
    gis.OGR_F_SetFieldString(f.get(), name, where);
    gis.OGR_F_SetGeometry(f.get(), shape);
    return layer.put(f);
  };
  for (const Line& line : lines_of(g)) {
    const std::string where = std::string_view(line.name) == "axis"   ? "AXIS"
                              : std::string_view(line.name) == "left" ? "RAIL_LEFT"
                                                                      : "RAIL_RIGHT";
    const bool good =
        each_piece(gis, g, line, stride_of(g, options), [&](OGRGeometryH piece) { return put(where.c_str(), piece); });
    if (!good) return refuse(gis, path);
  }
  const track::Column *e = g.find("easting_axis"), *n = g.find("northing_axis");
  if (quality != nullptr && e != nullptr) {
    for (const track::Exceedance& x : quality->exceedances) {
      if (!std::isfinite(e->value[x.index])) continue;
      if (!put("EXCEEDANCES", point_at(gis, e->value[x.index], n->value[x.index]).get())) return refuse(gis, path);
    }
  }
  return {};
}

}  // namespace versine::io
