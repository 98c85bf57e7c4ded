// SPDX-License-Identifier: Apache-2.0
#include "versine/io/background_map.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <vector>

#include "gdal.hpp"

namespace versine::io {

namespace {

/// Errors of GDAL come back as text instead of being printed.
class Quiet {
 public:
  explicit Quiet(const Gdal& gdal) : gdal_(gdal) {
    gdal_.CPLErrorReset();
    gdal_.CPLPushErrorHandler(gdal_.CPLQuietErrorHandler);
  }
  ~Quiet() { gdal_.CPLPopErrorHandler(); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
  [[nodiscard]] std::string message() const { return gdal_.CPLGetLastErrorMsg(); }

 private:
  const Gdal& gdal_;
};

Error unusable(const std::filesystem::path& path, std::string found) {
  return {
      .file = path.string(),
      .found = std::move(found),
      .expected = "a raster that knows where it lies: GeoTIFF, or MBTiles with pictures",
      .advice = "give a CRS to the picture (gdal_translate -a_srs EPSG:... -a_ullr ...), or leave --background away"};
}

}  // namespace

struct BackgroundMap::Impl {
  const Gdal* gdal = nullptr;
  GdalDataset set;
  std::string name;
  std::mutex mutex;
};

Expected<BackgroundMap> BackgroundMap::open(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) return tl::unexpected(unusable(path, "no such file"));
  const auto api = gdal(GdalDrivers::all);
  if (!api) return tl::unexpected(api.error());
  const Gdal& g = **api;
  const Quiet quiet(g);
  const auto open_as = [&](unsigned kind) {
    return owned<GdalDataset>(g, g.GDALOpenEx(path.c_str(), kind | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
  };
  GdalDataset set = open_as(GDAL_OF_RASTER);
  if (!set) {
    const GdalDataset vector = open_as(GDAL_OF_VECTOR);
    return tl::unexpected(unusable(path, vector ? "a map of lines, not a picture" : "no picture: " + quiet.message()));
  }
  std::array<double, 6> transform{};
  const bool placed =
      g.GDALGetGeoTransform(set.get(), transform.data()) == CE_None && g.GDALGetSpatialRef(set.get()) != nullptr;
  if (!placed || g.GDALGetRasterCount(set.get()) == 0) {
    return tl::unexpected(unusable(path, "a picture that does not say where it lies"));
  }
  auto impl = std::make_unique<Impl>();
  impl->gdal = &g;
  impl->set = std::move(set);
  impl->name = path.filename().string();
  return BackgroundMap(std::move(impl));
}

Expected<std::string> BackgroundMap::png(const std::string& crs, const std::array<double, 4>& window, int width,
                                         int height) const {
  const auto refuse = [&](std::string found) {
    return fail({.file = impl_->name,
                 .found = std::move(found),
                 .expected = fmt::format("a window of the map in {}", crs),
                 .advice = "choose a background of the survey's place, or leave --background away"});
  };
  std::vector<std::string> words = {"-of", "MEM", "-t_srs", crs, "-r", "bilinear", "-dstalpha", "-te"};
  for (const double edge : window) words.push_back(fmt::format("{:.4f}", edge));
  words.insert(words.end(), {"-ts", std::to_string(width), std::to_string(height)});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  const std::scoped_lock lock(impl_->mutex);
  const Gdal& g = *impl_->gdal;
  const Quiet quiet(g);
  GDALWarpAppOptions* options = g.GDALWarpAppOptionsNew(arguments.data(), nullptr);
  GDALDatasetH source = impl_->set.get();
  const auto warped = owned<GdalDataset>(g, g.GDALWarp("", nullptr, 1, &source, options, nullptr));
  g.GDALWarpAppOptionsFree(options);
  if (!warped) return refuse(quiet.message());
  static std::atomic<int> count{0};
  const std::string file = fmt::format("/vsimem/versine-background-{}.png", ++count);
  {
    GDALDriverH driver = g.GDALGetDriverByName("PNG");
    if (driver == nullptr) return refuse("a GDAL that writes no PNG");
    const auto written =
        owned<GdalDataset>(g, g.GDALCreateCopy(driver, file.c_str(), warped.get(), FALSE, nullptr, nullptr, nullptr));
    if (!written) return refuse(quiet.message());
  }
  vsi_l_offset size = 0;
  GByte* bytes = g.VSIGetMemFileBuffer(file.c_str(), &size, TRUE);
  if (bytes == nullptr) return refuse("no picture");
  std::string out(reinterpret_cast<const char*>(bytes), size);
  g.VSIFree(bytes);
  return out;
}

const std::string& BackgroundMap::name() const {
  return impl_->name;
}

BackgroundMap::BackgroundMap(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BackgroundMap::BackgroundMap(BackgroundMap&&) noexcept = default;
BackgroundMap& BackgroundMap::operator=(BackgroundMap&&) noexcept = default;
BackgroundMap::~BackgroundMap() = default;

}  // namespace versine::io
