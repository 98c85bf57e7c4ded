// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <filesystem>
#include <memory>
#include <string>

#include "versine/core/error.hpp"

namespace versine::io {

/// A picture of the ground to draw under a plan: a raster that GDAL can read and that knows where it lies (GeoTIFF,
/// MBTiles, ...). Windows of it are resampled into any CRS. May be asked by several threads.
class BackgroundMap {
 public:
  /// Fails when the file cannot be read, holds no raster (vector tiles), or does not know where it lies.
  [[nodiscard]] static Expected<BackgroundMap> open(const std::filesystem::path& path);

  /// What lies in [least easting, least northing, greatest easting, greatest northing] of a CRS (a definition as PROJ
  /// takes it), as a PNG of the given size in pixels, bilinear, transparent where the picture does not reach.
  /// REQUIRES 1 to 4096 pixels each way. Fails when the CRS is unknown or the window cannot be taken there.
  [[nodiscard]] Expected<std::string> png(const std::string& crs, const std::array<double, 4>& window, int width,
                                          int height) const;
  [[nodiscard]] const std::string& name() const;  ///< of the file

  BackgroundMap(BackgroundMap&&) noexcept;
  BackgroundMap& operator=(BackgroundMap&&) noexcept;
  ~BackgroundMap();

 private:
  struct Impl;
  explicit BackgroundMap(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace versine::io
