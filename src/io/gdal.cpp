// SPDX-License-Identifier: Apache-2.0
#include "gdal.hpp"

#include <dlfcn.h>
#include <proj.h>

#include <mutex>

namespace versine::io {

namespace {

Error unusable_gdal(const char* library, std::string found) {
  return {.file = library,
          .found = std::move(found),
          .expected = "GDAL, which reads and writes GeoPackage, Shapefile, DXF and pictures of the ground",
          .advice =
              "install the package of this library (Debian: libgdal32 or the one of your release), in the version "
              "that this program was built with"};
}

/// PROJ asks the loader once where it lies, when its settings are first read. Asked while GDAL is being loaded by
/// another thread, it would wait for the end of that.
void let_proj_ask_first() {
  PJ_CONTEXT* context = proj_context_create();
  proj_context_is_network_enabled(context);
  proj_context_destroy(context);
}

/// GDAL's own libraries before those of the program when names are looked up: half the time to load. Not where another
/// allocator (a sanitizer's, a preloaded one) stands before that of the C library, which GDAL would then not see.
int lookup_order() {
  void* c_library = ::dlopen("libc.so.6", RTLD_LAZY | RTLD_NOLOAD);
  const bool plain = c_library != nullptr && ::dlsym(c_library, "malloc") == ::dlsym(RTLD_DEFAULT, "malloc");
  if (c_library != nullptr) ::dlclose(c_library);
  return plain ? RTLD_DEEPBIND : 0;
}

}  // namespace

Expected<Gdal> load_gdal(const char* library) {
  let_proj_ask_first();
  // Never closed: it has threads' data and handlers for the end of the program.
  void* handle = ::dlopen(library, RTLD_LAZY | RTLD_LOCAL | lookup_order());
  if (handle == nullptr) {
    const char* why = ::dlerror();
    return tl::unexpected(unusable_gdal(library, why == nullptr ? "no such library" : why));
  }
  Gdal out;
  const char* missing = nullptr;
  const auto find = [&]<class F>(const char* name, F*& function) {
    function = reinterpret_cast<F*>(::dlsym(handle, name));
    if (function == nullptr && missing == nullptr) missing = name;
  };
#define VERSINE_GDAL_FIND(name) find(#name, out.name);
  VERSINE_GDAL_FUNCTIONS(VERSINE_GDAL_FIND)
  VERSINE_GDAL_FIND(RegisterOGRDXF)
  VERSINE_GDAL_FIND(RegisterOGRGeoPackage)
#undef VERSINE_GDAL_FIND
  if (missing != nullptr) return tl::unexpected(unusable_gdal(library, std::string("no function ") + missing));
  return out;
}

Expected<const Gdal*> gdal(GdalDrivers drivers) {
  static const Expected<Gdal> loaded = load_gdal(VERSINE_GDAL_LIBRARY);
  if (!loaded) return tl::unexpected(loaded.error());
  // Two threads that ask GDAL for the same driver at once may both make it; later calls find it and do nothing.
  static std::mutex registering;
  const std::scoped_lock lock(registering);
  switch (drivers) {
    case GdalDrivers::all:
      loaded->GDALAllRegister();
      break;
    case GdalDrivers::geopackage:
      loaded->RegisterOGRGeoPackage();
      break;
    case GdalDrivers::dxf:
      loaded->RegisterOGRDXF();
      break;
  }
  return &*loaded;
}

GdalDataset create_gdal_file(const Gdal& gdal, const char* driver, const char* path) {
  GDALDriverH made = gdal.GDALGetDriverByName(driver);
  return owned<GdalDataset>(gdal,
                            made == nullptr ? nullptr : gdal.GDALCreate(made, path, 0, 0, 0, GDT_Unknown, nullptr));
}

GdalCrs make_gdal_crs(const Gdal& gdal, const char* definition) {
  auto crs = owned<GdalCrs>(gdal, gdal.OSRNewSpatialReference(nullptr));
  if (definition == nullptr)
    gdal.OSRSetLocalCS(crs.get(), "project grid");
  else
    gdal.OSRSetFromUserInput(crs.get(), definition);
  gdal.OSRSetAxisMappingStrategy(crs.get(), OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

bool add_gdal_field(const Gdal& gdal, OGRLayerH layer, const char* name, OGRFieldType type) {
  const auto field = owned<GdalField>(gdal, gdal.OGR_Fld_Create(name, type));
  return gdal.OGR_L_CreateField(layer, field.get(), TRUE) == OGRERR_NONE;
}

}  // namespace versine::io
