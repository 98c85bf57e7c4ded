// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "gdal.hpp"
#include "versine/io/georef_result.hpp"

namespace versine::io {

namespace {

OGRLayerH make_layer(const Gdal& gdal, GDALDatasetH set, const char* name, OGRSpatialReferenceH crs,
                     OGRwkbGeometryType type, std::initializer_list<std::pair<const char*, OGRFieldType>> fields) {
  OGRLayerH layer = gdal.GDALDatasetCreateLayer(set, name, crs, type, nullptr);
  for (const auto& [field, kind] : fields) {
    if (layer != nullptr && !add_gdal_field(gdal, layer, field, kind)) return nullptr;
  }
  return layer;
}

bool add_path(const Gdal& gdal, OGRLayerH layer, const georef::Map& map, const georef::PathSolution& p, int r, int k,
              int i) {
  const auto f = owned<GdalFeature>(gdal, gdal.OGR_F_Create(gdal.OGR_L_GetLayerDefn(layer)));
  gdal.OGR_F_SetFieldInteger(f.get(), 0, r);
  gdal.OGR_F_SetFieldInteger(f.get(), 1, k);
  gdal.OGR_F_SetFieldInteger(f.get(), 2, i);
  gdal.OGR_F_SetFieldDouble(f.get(), 3, p.probability);
  const auto line = owned<GdalGeometry>(gdal, gdal.OGR_G_CreateGeometry(wkbLineString));
  const double from = std::max(0.0, p.motion.distance.front()),
               to = std::min(p.coordinates.length(), p.motion.distance.back());
  const auto steps = std::max(2, static_cast<int>((to - from) / 10.0) + 2);
  for (int s = 0; s < steps; ++s) {
    const Eigen::Vector2d q = p.coordinates.position(from + (to - from) * s / (steps - 1)) + map.network.origin;
    gdal.OGR_G_AddPoint_2D(line.get(), q.x(), q.y());
  }
  gdal.OGR_F_SetGeometry(f.get(), line.get());
  return gdal.OGR_L_CreateFeature(layer, f.get()) == OGRERR_NONE;
}

bool add_positions(const Gdal& gdal, OGRLayerH layer, const georef::Map& map, const georef::JourneyResult& j, int r,
                   int k, double interval) {
  const auto& best = j.paths.front();
  const auto every = static_cast<std::size_t>(std::max(1.0, std::round(interval / j.grid)));
  for (std::size_t i = 0; i < j.steps; i += every) {
    const double d = best.motion.distance[i];
    const auto place = best.coordinates.place(d);
    const auto& track = map.network.tracks[place.track.track];
    const Eigen::Vector2d q = best.coordinates.position(d) + map.network.origin;
    const auto f = owned<GdalFeature>(gdal, gdal.OGR_F_Create(gdal.OGR_L_GetLayerDefn(layer)));
    gdal.OGR_F_SetFieldInteger(f.get(), 0, r);
    gdal.OGR_F_SetFieldInteger(f.get(), 1, k);
    gdal.OGR_F_SetFieldString(f.get(), 3, track.line_id.c_str());
    const auto set = [&](int field, double value) { gdal.OGR_F_SetFieldDouble(f.get(), field, value); };
    set(2, (j.start + Duration::from_seconds(j.grid * static_cast<double>(i))).seconds());
    set(4, track.line_offset + place.distance);
    set(5, static_cast<double>(best.motion.speed[i]));
    set(6, static_cast<double>(best.motion.sigma_distance[i]));
    set(7, best.probability);
    const auto point = owned<GdalGeometry>(gdal, gdal.OGR_G_CreateGeometry(wkbPoint));
    gdal.OGR_G_AddPoint_2D(point.get(), q.x(), q.y());
    gdal.OGR_F_SetGeometry(f.get(), point.get());
    if (gdal.OGR_L_CreateFeature(layer, f.get()) != OGRERR_NONE) return false;
  }
  return true;
}

}  // namespace

Expected<void> write_georef_gpkg(const std::filesystem::path& path, const georef::Map& map, const std::string& wkt,
                                 const GeorefResults& results, double interval) {
  const auto api = gdal(GdalDrivers::geopackage);
  if (!api) return tl::unexpected(api.error());
  const Gdal& g = **api;
  const auto refuse = [&] {
    return fail({.file = path.string(),
                 .found = "a file that cannot be written",
                 .expected = "a writable folder with space",
                 .advice = g.CPLGetLastErrorMsg()});
  };
  const GdalDataset set = create_gdal_file(g, "GPKG", path.c_str());
  if (set == nullptr) return refuse();
  const GdalCrs crs = make_gdal_crs(g, wkt.c_str());
  OGRLayerH paths =
      make_layer(g, set.get(), "paths", crs.get(), wkbLineString,
                 {{"recording", OFTInteger}, {"journey", OFTInteger}, {"path", OFTInteger}, {"probability", OFTReal}});
  OGRLayerH points = make_layer(g, set.get(), "positions", crs.get(), wkbPoint,
                                {{"recording", OFTInteger},
                                 {"journey", OFTInteger},
                                 {"time_s", OFTReal},
                                 {"track", OFTString},
                                 {"track_distance_m", OFTReal},
                                 {"speed_mps", OFTReal},
                                 {"sigma_m", OFTReal},
                                 {"probability", OFTReal}});
  if (paths == nullptr || points == nullptr || g.GDALDatasetStartTransaction(set.get(), FALSE) != OGRERR_NONE)
    return refuse();
  for (std::size_t r = 0; r < results.size(); ++r) {
    if (results[r] == nullptr) continue;
    for (std::size_t k = 0; k < results[r]->journeys.size(); ++k) {
      const auto& j = results[r]->journeys[k];
      const int rn = static_cast<int>(r) + 1, kn = static_cast<int>(k) + 1;
      for (std::size_t p = 0; p < j.paths.size(); ++p) {
        if (!add_path(g, paths, map, j.paths[p], rn, kn, static_cast<int>(p) + 1)) return refuse();
      }
      if (!add_positions(g, points, map, j, rn, kn, interval)) return refuse();
    }
  }
  if (g.GDALDatasetCommitTransaction(set.get()) != OGRERR_NONE) return refuse();
  return {};
}

void prepare_georef_gpkg() {
  (void)gdal(GdalDrivers::geopackage);  // the writer tells what went wrong
}

}  // namespace versine::io
