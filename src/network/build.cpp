// SPDX-License-Identifier: Apache-2.0
#include "versine/network/build.hpp"

#include <fmt/format.h>

#include <climits>
#include <cmath>
#include <map>
#include <numbers>

#include "build_stages.hpp"
#include "versine/core/units.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::network {

namespace {

struct Extent {
  Eigen::Vector2d low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
  void add(const Eigen::Vector2d& p) {
    if (!p.allFinite()) return;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  [[nodiscard]] bool empty() const { return !(low.x() <= high.x()); }
  [[nodiscard]] Eigen::Vector2d middle() const { return 0.5 * (low + high); }
};

Extent extent_of(const NetworkSource& source) {
  Extent extent;
  for (const auto& track : source.tracks) {
    for (const auto& p : track.points) extent.add(p);
  }
  return extent;
}

Expected<geodesy::Projection> choose_projection(const NetworkSource& source, const Extent& extent,
                                                const BuildOptions& options) {
  const bool geographic = source.crs.empty();
  geodesy::Geodetic middle{extent.middle().y(), extent.middle().x(), 0.0};
  if (!geographic) {
    auto own = geodesy::Projection::create(source.crs);
    if (!own || options.crs.empty()) return own;
    middle = own->inverse({extent.middle().x(), extent.middle().y(), 0.0});
  }
  if (options.crs.empty()) return geodesy::Projection::transverse_mercator(middle.longitude);
  if (options.crs == "utm") return geodesy::Projection::utm(middle);
  return geodesy::Projection::create(options.crs);
}

/// The file's coordinates cannot be what its CRS says.
Expected<void> check_units(const NetworkSource& source, const Extent& extent) {
  const bool degrees = extent.high.cwiseAbs().maxCoeff() <= 360.0 && extent.low.cwiseAbs().maxCoeff() <= 360.0;
  if (!source.crs.empty() && degrees) {
    return fail(
        {.file = source.file,
         .field = "crs",
         .found = fmt::format("coordinates from ({:.4f}, {:.4f}) to ({:.4f}, {:.4f}), which look like degrees, with "
                              "a projected CRS",
                              extent.low.x(), extent.low.y(), extent.high.x(), extent.high.y()),
         .expected = "map metres",
         .advice = "correct the file's CRS, or set network.source_crs = \"EPSG:4326\""});
  }
  const double pi = std::numbers::pi;
  if (source.crs.empty() &&
      (extent.high.x() > pi || extent.low.x() < -pi || extent.high.y() > 0.5 * pi || extent.low.y() < -0.5 * pi)) {
    return fail({.file = source.file,
                 .field = "crs",
                 .found = fmt::format("coordinates up to ({:.1f}, {:.1f}) without a CRS", extent.high.x() / units::deg,
                                      extent.high.y() / units::deg),
                 .expected = "longitude and latitude in degrees, or a CRS",
                 .advice = "name the map's projection: network.source_crs = \"EPSG:25832\""});
  }
  return {};
}

/// Map metres per ground metre, biquadratic through points of a 5 km grid: better than 1e-9.
class ScaleField {
 public:
  explicit ScaleField(const geodesy::Projection& projection) : projection_(projection) {}
  double at(const Eigen::Vector2d& p) {
    const Eigen::Vector2d nearest = (p / spacing).array().round(), u = p / spacing - nearest;
    const std::pair index(static_cast<long>(nearest.x()), static_cast<long>(nearest.y()));
    if (index != last_) {  // the next point is mostly near the same
      last_ = index;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) around_(i, j) = node(index.first + i - 1, index.second + j - 1);
      }
    }
    return weights(u.x()).dot(around_ * weights(u.y()));
  }

 private:
  static constexpr double spacing = 5000.0;

  static Eigen::Vector3d weights(double u) { return {0.5 * u * (u - 1.0), 1.0 - u * u, 0.5 * u * (u + 1.0)}; }

  double node(long i, long j) {
    const auto [it, added] = nodes_.try_emplace({i, j}, 1.0);
    if (added) {
      // From 100 m of the map: PROJ's own factors cost a search of its database each time.
      const double x = static_cast<double>(i) * spacing, y = static_cast<double>(j) * spacing;
      const auto south = projection_.inverse({x, y - 50.0, 0.0}), north = projection_.inverse({x, y + 50.0, 0.0});
      const double middle = 0.5 * (south.latitude + north.latitude);
      const double scale =
          100.0 /
          std::hypot(geodesy::wgs84.meridian_radius(middle) * (north.latitude - south.latitude),
                     geodesy::wgs84.transverse_radius(middle) * std::cos(middle) * (north.longitude - south.longitude));
      if (scale > 0.5 && scale < 2.0) it->second = scale;
    }
    return it->second;
  }

  const geodesy::Projection& projection_;
  std::map<std::pair<long, long>, double> nodes_;
  std::pair<long, long> last_{LONG_MAX, LONG_MAX};
  Eigen::Matrix3d around_ = Eigen::Matrix3d::Ones();
};

}  // namespace

Expected<Network> build(const NetworkSource& source, const BuildOptions& options) {
  const Extent extent = extent_of(source);
  if (extent.empty()) {
    return fail({.file = source.file,
                 .found = fmt::format("{} lines, none with coordinates", source.tracks.size()),
                 .expected = "railway tracks as lines",
                 .advice = "name the layer, or the railway types to be read"});
  }
  if (auto ok = check_units(source, extent); !ok) return tl::unexpected(ok.error());
  auto projection = choose_projection(source, extent, options);
  if (!projection) {
    Error error = projection.error();
    if (error.file.empty()) error.file = source.file;
    return tl::unexpected(error);
  }

  // Everything into the map, relative to a round origin near the middle, where doubles and eyes are comfortable.
  std::optional<geodesy::Projection> from;
  if (!source.crs.empty() && !options.crs.empty()) from = *geodesy::Projection::create(source.crs);
  const auto to_map = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    if (!source.crs.empty() && !from) return p;
    const geodesy::Geodetic g = from ? from->inverse({p.x(), p.y(), 0.0}) : geodesy::Geodetic{p.y(), p.x(), 0.0};
    const auto m = projection->forward(g);
    return {m.easting, m.northing};
  };
  const Eigen::Vector2d origin = (to_map(extent.middle()) / 1000.0).array().round() * 1000.0;
  if (!origin.allFinite()) {
    return fail({.file = source.file,
                 .field = "crs",
                 .found = "coordinates outside the projection's area",
                 .expected = "a projection made for the network's place",
                 .advice = "set network.crs, or leave it out"});
  }
  std::vector<std::vector<Eigen::Vector2d>> points;
  std::vector<std::vector<double>> scales;
  ScaleField scale_field(*projection);
  points.reserve(source.tracks.size());
  for (const auto& track : source.tracks) {
    auto& line = points.emplace_back();
    line.reserve(track.points.size());
    auto& scale = scales.emplace_back();
    scale.reserve(track.points.size());
    for (const auto& p : track.points) {
      const Eigen::Vector2d at = to_map(p);
      line.push_back(at - origin);
      scale.push_back(at.allFinite() ? scale_field.at(at) : 1.0);
    }
  }

  Network network{source.file, std::move(*projection), origin, {}, {}, {}, {}, {}};
  auto lines = detail::project_lines(source, points, scales, network.record);
  if (lines.lines.empty()) {
    return fail({.file = source.file,
                 .found = fmt::format("{} lines, none of them a track", source.tracks.size()),
                 .expected = "lines of two or more distinct points",
                 .advice = network.record.warnings.empty() ? "" : network.record.warnings.front()});
  }
  detail::find_cuts(source, options, lines, network.record);
  detail::split_lines(lines, network);
  const auto labels = detail::labels_of(source, options, lines, network.record);
  detail::join_ends(source, options, lines, labels, network);
  detail::find_connections(options, lines, labels, network);
  return network;
}

}  // namespace versine::network
