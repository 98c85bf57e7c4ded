// SPDX-License-Identifier: Apache-2.0
#include "versine/geodesy/projection.hpp"

#include <fmt/format.h>
#include <proj.h>

#include <cmath>
#include <numbers>

#include "versine/core/units.hpp"

namespace versine::geodesy {

struct Projection::Impl {
  struct Context {
    PJ_CONTEXT* handle = proj_context_create();
    Context() { proj_log_level(handle, PJ_LOG_NONE); }
    ~Context() { proj_context_destroy(handle); }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
  };

  Context context;
  std::string definition;
  PJ* to_map = nullptr;  // WGS84 longitude, latitude in degrees -> easting, northing
  PJ* crs = nullptr;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (to_map != nullptr) proj_destroy(to_map);
    if (crs != nullptr) proj_destroy(crs);
  }
};

Expected<Projection> Projection::create(const std::string& definition) {
  auto impl = std::make_unique<Impl>();
  impl->definition = definition;
  PJ_CONTEXT* context = impl->context.handle;
  // A bare projection string is not a CRS yet; PROJ wants "+type=crs" to treat it as one.
  std::string text = definition;
  if (text.find("+proj") != std::string::npos && text.find("+type=crs") == std::string::npos) text += " +type=crs";
  impl->crs = proj_create(context, text.c_str());
  const auto refuse = [&](const std::string& why) {
    return fail({.field = "crs",
                 .found = fmt::format("'{}' ({})", definition, why),
                 .expected = "a projected coordinate reference system that PROJ knows",
                 .advice = "name it as 'EPSG:25832', as a PROJ string '+proj=tmerc +lat_0=0 +lon_0=9 ...', or as WKT"});
  };
  if (impl->crs == nullptr) return refuse(proj_context_errno_string(context, proj_context_errno(context)));
  PJ* raw = proj_create_crs_to_crs(context, "EPSG:4979", text.c_str(), nullptr);
  if (raw == nullptr) raw = proj_create_crs_to_crs(context, "EPSG:4326", text.c_str(), nullptr);
  if (raw == nullptr) return refuse(proj_context_errno_string(context, proj_context_errno(context)));
  impl->to_map = proj_normalize_for_visualization(context, raw);
  proj_destroy(raw);
  if (impl->to_map == nullptr) return refuse("no axis order could be found");
  // A geographic CRS has no metres: results of ours would be nonsense in it.
  PJ* base = proj_get_type(impl->crs) == PJ_TYPE_BOUND_CRS ? proj_get_source_crs(context, impl->crs) : nullptr;
  const PJ_TYPE type = proj_get_type(base != nullptr ? base : impl->crs);
  if (base != nullptr) proj_destroy(base);
  if (type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS || type == PJ_TYPE_GEOCENTRIC_CRS) {
    return refuse("it is not projected: its coordinates are no map metres");
  }
  return Projection(std::move(impl));
}

Expected<Projection> Projection::transverse_mercator(double central_meridian, double scale, double false_easting,
                                                     double latitude_of_origin) {
  return create(
      fmt::format("+proj=tmerc +lat_0={:.15g} +lon_0={:.15g} +k={:.15g} +x_0={:.15g} +y_0=0 +ellps=WGS84 "
                  "+units=m +no_defs",
                  latitude_of_origin / units::deg, central_meridian / units::deg, scale, false_easting));
}

Expected<Projection> Projection::utm(const Geodetic& place) {
  const int zone = std::clamp(static_cast<int>(std::floor((place.longitude / units::deg + 180.0) / 6.0)) + 1, 1, 60);
  return create(fmt::format("EPSG:{}", (place.latitude >= 0.0 ? 32600 : 32700) + zone));
}

Projection::Projection(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Projection::Projection(const Projection& other) : impl_(std::make_unique<Impl>()) {
  // Cloning is a fiftieth of the work of finding the operations in PROJ's database again.
  impl_->definition = other.impl_->definition;
  impl_->to_map = proj_clone(impl_->context.handle, other.impl_->to_map);
  impl_->crs = proj_clone(impl_->context.handle, other.impl_->crs);
}
Projection& Projection::operator=(const Projection& other) {
  if (this != &other) *this = Projection(other);
  return *this;
}
Projection::Projection(Projection&&) noexcept = default;
Projection& Projection::operator=(Projection&&) noexcept = default;
Projection::~Projection() = default;

MapPoint Projection::forward(const Geodetic& g) const {
  const PJ_COORD out =
      proj_trans(impl_->to_map, PJ_FWD, proj_coord(g.longitude / units::deg, g.latitude / units::deg, g.height, 0.0));
  if (!std::isfinite(out.xyz.x) || !std::isfinite(out.xyz.y)) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan};
  }
  return {out.xyz.x, out.xyz.y, out.xyz.z};
}

Geodetic Projection::inverse(const MapPoint& p) const {
  const PJ_COORD out = proj_trans(impl_->to_map, PJ_INV, proj_coord(p.easting, p.northing, p.height, 0.0));
  if (!std::isfinite(out.xyz.x) || !std::isfinite(out.xyz.y)) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan};
  }
  return {out.xyz.y * units::deg, out.xyz.x * units::deg, out.xyz.z};
}

Projection::Distortion Projection::distortion(const Geodetic& g) const {
  PJ_COORD at = proj_coord(g.longitude, g.latitude, 0.0, 0.0);
  const PJ_FACTORS f = proj_factors(impl_->crs, at);
  return {f.meridional_scale, f.meridian_convergence};
}

const std::string& Projection::definition() const {
  return impl_->definition;
}

std::string Projection::wkt() const {
  const char* text = proj_as_wkt(impl_->context.handle, impl_->crs, PJ_WKT2_2019, nullptr);
  return text == nullptr ? impl_->definition : text;
}

}  // namespace versine::geodesy
