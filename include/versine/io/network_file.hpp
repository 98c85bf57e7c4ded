// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "versine/core/error.hpp"
#include "versine/network/source.hpp"

namespace versine::io {

struct NetworkFile {
  std::filesystem::path path;
  std::string layer;       ///< of a GeoPackage or similar; empty: the first layer with lines
  std::string id_field;    ///< attribute that names a track; empty: id, name or track_id, else the feature's number
  std::string source_crs;  ///< overrides the file's own CRS
  std::vector<std::string> osm_types{"rail", "light_rail"};  ///< values of OpenStreetMap's railway tag
};

/// Reads a railway map by its kind: OpenStreetMap (.osm, .osm.pbf, .osm.bz2, .osm.gz) through libosmium; GeoJSON (also
/// .zst and .gz) with labels where it has them (network_labelled.hpp); everything else (GeoPackage, Shapefile, ...)
/// through GDAL. Fails naming the file, and the layer or field that is missing.
[[nodiscard]] Expected<network::NetworkSource> read_network(const NetworkFile& file);

[[nodiscard]] Expected<network::NetworkSource> read_osm_network(const NetworkFile& file);
[[nodiscard]] Expected<network::NetworkSource> read_gdal_network(const NetworkFile& file);

}  // namespace versine::io
