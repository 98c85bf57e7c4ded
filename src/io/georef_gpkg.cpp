// SPDX-License-Identifier: Apache-2.0
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <memory>

#include "versine/io/georef_result.hpp"

namespace versine::io {

namespace {

OGRLayer* make_layer(GDALDataset& set, const char* name, OGRSpatialReference& crs, OGRwkbGeometryType type,
                     std::initializer_list<std::pair<const char*, OGRFieldType>> fields) {
  OGRLayer* layer = set.CreateLayer(name, &crs, type, nullptr);
  for (const auto& [field, kind] : fields) {
    OGRFieldDefn def(field, kind);
    if (layer != nullptr && layer->CreateField(&def) != OGRERR_NONE) return nullptr;
  }
  return layer;
}

bool add_path(OGRLayer& layer, const georef::Map& map, const georef::PathSolution& p, int r, int k, int i) {
  const std::unique_ptr<OGRFeature> f(OGRFeature::CreateFeature(layer.GetLayerDefn()));
  f->SetField(0, r), f->SetField(1, k), f->SetField(2, i), f->SetField(3, p.probability);
  OGRLineString line;
  const double from = std::max(0.0, p.motion.distance.front()),
               to = std::min(p.coordinates.length(), p.motion.distance.back());
  const auto steps = std::max(2, static_cast<int>((to - from) / 10.0) + 2);
  for (int s = 0; s < steps; ++s) {
    const Eigen::Vector2d q = p.coordinates.position(from + (to - from) * s / (steps - 1)) + map.network.origin;
    line.addPoint(q.x(), q.y());
  }
  f->SetGeometry(&line);
  return layer.CreateFeature(f.get()) == OGRERR_NONE;
}

bool add_positions(OGRLayer& layer, const georef::Map& map, const georef::JourneyResult& j, int r, int k,
                   double interval) {
  const auto& best = j.paths.front();
  const auto every = static_cast<std::size_t>(std::max(1.0, std::round(interval / j.grid)));
  for (std::size_t i = 0; i < j.steps; i += every) {
    const double d = best.motion.distance[i];
    const auto place = best.coordinates.place(d);
    const auto& track = map.network.tracks[place.track.track];
    const Eigen::Vector2d q = best.coordinates.position(d) + map.network.origin;
    const std::unique_ptr<OGRFeature> f(OGRFeature::CreateFeature(layer.GetLayerDefn()));
    f->SetField(0, r), f->SetField(1, k);
    f->SetField(2, (j.start + Duration::from_seconds(j.grid * static_cast<double>(i))).seconds());
    f->SetField(3, track.line_id.c_str()), f->SetField(4, track.line_offset + place.distance);
    f->SetField(5, static_cast<double>(best.motion.speed[i]));
    f->SetField(6, static_cast<double>(best.motion.sigma_distance[i])), f->SetField(7, best.probability);
    OGRPoint point(q.x(), q.y());
    f->SetGeometry(&point);
    if (layer.CreateFeature(f.get()) != OGRERR_NONE) return false;
  }
  return true;
}

}  // namespace

Expected<void> write_georef_gpkg(const std::filesystem::path& path, const georef::Map& map,
                                 const GeorefResults& results, double interval) {
  const auto refuse = [&] {
    return fail({.file = path.string(),
                 .found = "a file that cannot be written",
                 .expected = "a writable folder with space",
                 .advice = CPLGetLastErrorMsg()});
  };
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  if (driver == nullptr) return refuse();
  GDALDataset* set = driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr);
  if (set == nullptr) return refuse();
  const std::unique_ptr<GDALDataset, void (*)(GDALDataset*)> owner(set, [](GDALDataset* d) { GDALClose(d); });
  OGRSpatialReference crs;
  crs.SetFromUserInput(map.network.projection.wkt().c_str());
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRLayer* paths =
      make_layer(*set, "paths", crs, wkbLineString,
                 {{"recording", OFTInteger}, {"journey", OFTInteger}, {"path", OFTInteger}, {"probability", OFTReal}});
  OGRLayer* points = make_layer(*set, "positions", crs, wkbPoint,
                                {{"recording", OFTInteger},
                                 {"journey", OFTInteger},
                                 {"time_s", OFTReal},
                                 {"track", OFTString},
                                 {"track_distance_m", OFTReal},
                                 {"speed_mps", OFTReal},
                                 {"sigma_m", OFTReal},
                                 {"probability", OFTReal}});
  if (paths == nullptr || points == nullptr || set->StartTransaction() != OGRERR_NONE) return refuse();
  for (std::size_t r = 0; r < results.size(); ++r) {
    if (results[r] == nullptr) continue;
    for (std::size_t k = 0; k < results[r]->journeys.size(); ++k) {
      const auto& j = results[r]->journeys[k];
      const int rn = static_cast<int>(r) + 1, kn = static_cast<int>(k) + 1;
      for (std::size_t p = 0; p < j.paths.size(); ++p) {
        if (!add_path(*paths, map, j.paths[p], rn, kn, static_cast<int>(p) + 1)) return refuse();
      }
      if (!add_positions(*points, map, j, rn, kn, interval)) return refuse();
    }
  }
  if (set->CommitTransaction() != OGRERR_NONE) return refuse();
  return {};
}

}  // namespace versine::io
