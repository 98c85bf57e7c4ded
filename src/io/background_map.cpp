// SPDX-License-Identifier: Apache-2.0
#include "versine/io/background_map.hpp"

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gdal_utils.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <vector>

namespace versine::io {

namespace {

using Dataset = std::unique_ptr<GDALDataset, void (*)(GDALDataset*)>;

Dataset owned(GDALDatasetH handle) {
  return {GDALDataset::FromHandle(handle), [](GDALDataset* d) {
            if (d != nullptr) GDALClose(GDALDataset::ToHandle(d));
          }};
}

/// Errors of GDAL come back as text instead of being printed.
class Quiet {
 public:
  Quiet() {
    CPLErrorReset();
    CPLPushErrorHandler(CPLQuietErrorHandler);
  }
  ~Quiet() { CPLPopErrorHandler(); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
  [[nodiscard]] static std::string message() { return CPLGetLastErrorMsg(); }
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
  Dataset set{nullptr, nullptr};
  std::string name;
  std::mutex mutex;
};

Expected<BackgroundMap> BackgroundMap::open(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) return tl::unexpected(unusable(path, "no such file"));
  GDALAllRegister();
  const Quiet quiet;
  Dataset set = owned(GDALOpenEx(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
  if (!set) {
    const Dataset vector =
        owned(GDALOpenEx(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
    return tl::unexpected(unusable(path, vector ? "a map of lines, not a picture" : "no picture: " + Quiet::message()));
  }
  std::array<double, 6> transform{};
  const bool placed = set->GetGeoTransform(transform.data()) == CE_None && set->GetSpatialRef() != nullptr;
  if (!placed || set->GetRasterCount() == 0) {
    return tl::unexpected(unusable(path, "a picture that does not say where it lies"));
  }
  auto impl = std::make_unique<Impl>();
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
  const Quiet quiet;
  GDALWarpAppOptions* options = GDALWarpAppOptionsNew(arguments.data(), nullptr);
  GDALDatasetH source = GDALDataset::ToHandle(impl_->set.get());
  const Dataset warped = owned(GDALWarp("", nullptr, 1, &source, options, nullptr));
  GDALWarpAppOptionsFree(options);
  if (!warped) return refuse(Quiet::message());
  static std::atomic<int> count{0};
  const std::string file = fmt::format("/vsimem/versine-background-{}.png", ++count);
  {
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("PNG");
    if (driver == nullptr) return refuse("a GDAL that writes no PNG");
    const Dataset written =
        owned(GDALDataset::ToHandle(driver->CreateCopy(file.c_str(), warped.get(), FALSE, nullptr, nullptr, nullptr)));
    if (!written) return refuse(Quiet::message());
  }
  vsi_l_offset size = 0;
  GByte* bytes = VSIGetMemFileBuffer(file.c_str(), &size, TRUE);
  if (bytes == nullptr) return refuse("no picture");
  std::string out(reinterpret_cast<const char*>(bytes), size);
  VSIFree(bytes);
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
