// SPDX-License-Identifier: Apache-2.0
#include "versine/io/geometry_gis.hpp"

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <memory>

#include "versine/geodesy/projection.hpp"

namespace versine::io {
namespace {

using Dataset = std::unique_ptr<GDALDataset, void (*)(GDALDataset*)>;
using Feature = std::unique_ptr<OGRFeature>;

Expected<void> refuse(const std::filesystem::path& path) {
  return fail({.file = path.string(),
               .found = "a file that cannot be written",
               .expected = "a writable folder with space",
               .advice = CPLGetLastErrorMsg()});
}

Dataset create(const char* driver_name, const std::filesystem::path& path) {
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(driver_name);
  GDALDataset* set = driver == nullptr ? nullptr : driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr);
  return {set, [](GDALDataset* d) {
            if (d != nullptr) GDALClose(d);
          }};
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
bool each_piece(const track::Geometry& g, const Line& line, std::size_t stride, const Use& use) {
  OGRLineString piece;
  const auto finish = [&] {
    const bool good = piece.getNumPoints() < 2 || use(piece);
    piece.empty();
    return good;
  };
  for (std::size_t i = 0; i < g.size(); ++i) {
    const bool last = i + 1 == g.size();
    if (i % stride != 0 && !last) continue;
    const double e = line.easting->value[i], n = line.northing->value[i], h = line.height->value[i];
    if (std::isfinite(e) && std::isfinite(h))
      piece.addPoint(e, n, h);
    else if (!finish())
      return false;
  }
  return finish();
}

bool add_field(OGRLayer& layer, const std::string& name, OGRFieldType type) {
  OGRFieldDefn definition(name.c_str(), type);
  return layer.CreateField(&definition) == OGRERR_NONE;
}

bool write_lines(GDALDataset& set, OGRSpatialReference& crs, const track::Geometry& g, std::size_t stride) {
  for (const char* layer_name : {"axis", "rails"}) {
    OGRLayer* layer = set.CreateLayer(layer_name, &crs, wkbLineString25D, nullptr);
    if (layer == nullptr || !add_field(*layer, "rail", OFTString)) return false;
    for (const Line& line : lines_of(g)) {
      if ((std::string_view(line.name) == "axis") != (std::string_view(layer_name) == "axis")) continue;
      const bool good = each_piece(g, line, stride, [&](const OGRLineString& piece) {
        const Feature f(OGRFeature::CreateFeature(layer->GetLayerDefn()));
        f->SetField(0, line.name);
        f->SetGeometry(&piece);
        return layer->CreateFeature(f.get()) == OGRERR_NONE;
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

bool write_points(GDALDataset& set, OGRSpatialReference& crs, const track::Geometry& g, std::size_t stride) {
  const auto lines = lines_of(g);
  if (lines.empty()) return true;
  const Line& axis = lines.front();
  OGRLayer* layer = set.CreateLayer("points", &crs, wkbPoint25D, nullptr);
  if (layer == nullptr || !add_field(*layer, "mileage_m", OFTReal) || !add_field(*layer, "flags", OFTInteger))
    return false;
  std::vector<const track::Column*> columns;
  for (const track::Column& c : g.columns) {
    if (wanted(c) && add_field(*layer, c.heading(), OFTReal)) columns.push_back(&c);
  }
  const Feature f(OGRFeature::CreateFeature(layer->GetLayerDefn()));
  for (std::size_t i = 0; i < g.size(); i += stride) {
    const double e = axis.easting->value[i], n = axis.northing->value[i], h = axis.height->value[i];
    if (!std::isfinite(e)) continue;
    f->SetFID(OGRNullFID);
    f->SetField(0, g.posted_at(g.mileage[i]));
    f->SetField(1, static_cast<int>(g.flags[i]));
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const double v = columns[k]->value[i] / columns[k]->scale;
      if (std::isfinite(v))
        f->SetField(static_cast<int>(k) + 2, v);
      else
        f->SetFieldNull(static_cast<int>(k) + 2);
    }
    OGRPoint point(e, n, h);
    f->SetGeometry(&point);
    if (layer->CreateFeature(f.get()) != OGRERR_NONE) return false;
  }
  return true;
}

bool write_exceedances(GDALDataset& set, OGRSpatialReference& crs, const track::Geometry& g, const track::Quality& q) {
  OGRLayer* layer = set.CreateLayer("exceedances", &crs, wkbPoint, nullptr);
  if (layer == nullptr) return false;
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
    if (!add_field(*layer, name, type)) return false;
  }
  const auto lines = lines_of(g);
  for (const track::Exceedance& x : q.exceedances) {
    const track::Column& c = g.at(x.column);
    const Feature f(OGRFeature::CreateFeature(layer->GetLayerDefn()));
    f->SetField(0, x.column.c_str());
    f->SetField(1, x.level.c_str());
    f->SetField(2, c.unit.c_str());
    const double numbers[] = {x.value / c.scale,    x.limit / c.scale,  x.sigma / c.scale,  x.probability,
                              g.posted_at(x.start), g.posted_at(x.end), g.posted_at(x.peak)};
    for (int k = 0; k < 7; ++k) {
      if (std::isfinite(numbers[k])) f->SetField(k + 3, numbers[k]);
    }
    if (!lines.empty() && std::isfinite(lines.front().easting->value[x.index])) {
      OGRPoint point(lines.front().easting->value[x.index], lines.front().northing->value[x.index]);
      f->SetGeometry(&point);
    }
    if (layer->CreateFeature(f.get()) != OGRERR_NONE) return false;
  }
  return true;
}

}  // namespace

Expected<void> write_geometry_gpkg(const std::filesystem::path& path, const track::Geometry& g,
                                   const track::Quality* quality, const GisOptions& options) {
  Dataset set = create("GPKG", path);
  if (set == nullptr) return refuse(path);
  OGRSpatialReference crs;
  const auto projection = geodesy::Projection::create(g.crs);
  if (!projection) return tl::unexpected(projection.error());
  if (g.own_grid)
    crs.SetLocalCS("project grid");
  else
    crs.SetFromUserInput(projection->wkt().c_str());
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::size_t stride = stride_of(g, options);
  const bool good = set->StartTransaction() == OGRERR_NONE && write_lines(*set, crs, g, stride) &&
                    write_points(*set, crs, g, stride) &&
                    (quality == nullptr || write_exceedances(*set, crs, g, *quality)) &&
                    set->CommitTransaction() == OGRERR_NONE;
  if (!good) return refuse(path);
  return {};
}

Expected<void> write_geometry_dxf(const std::filesystem::path& path, const track::Geometry& g,
                                  const track::Quality* quality, const GisOptions& options) {
  Dataset set = create("DXF", path);
  OGRLayer* layer = set == nullptr ? nullptr : set->CreateLayer("entities", nullptr, wkbUnknown, nullptr);
  if (layer == nullptr) return refuse(path);
  const int name = layer->GetLayerDefn()->GetFieldIndex("Layer");
  const auto put = [&](const char* where, const OGRGeometry& shape) {
    const Feature f(OGRFeature::CreateFeature(layer->GetLayerDefn()));
    f->SetField(name, where);
    f->SetGeometry(&shape);
    return layer->CreateFeature(f.get()) == OGRERR_NONE;
  };
  for (const Line& line : lines_of(g)) {
    const std::string where = std::string_view(line.name) == "axis"   ? "AXIS"
                              : std::string_view(line.name) == "left" ? "RAIL_LEFT"
                                                                      : "RAIL_RIGHT";
    const bool good = each_piece(g, line, stride_of(g, options),
                                 [&](const OGRLineString& piece) { return put(where.c_str(), piece); });
    if (!good) return refuse(path);
  }
  const track::Column *e = g.find("easting_axis"), *n = g.find("northing_axis");
  if (quality != nullptr && e != nullptr) {
    for (const track::Exceedance& x : quality->exceedances) {
      if (!std::isfinite(e->value[x.index])) continue;
      if (!put("EXCEEDANCES", OGRPoint(e->value[x.index], n->value[x.index]))) return refuse(path);
    }
  }
  return {};
}

}  // namespace versine::io
