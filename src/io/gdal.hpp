// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <gdal_utils.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <memory>

#include "versine/core/error.hpp"

/// GDAL, loaded when it is first used: the loader takes 40 ms for it and the hundred libraries that it brings, which
/// a program that writes no GeoPackage need not wait for. Only its C interface, whose names the library keeps.
namespace versine::io {

#define VERSINE_GDAL_FUNCTIONS(X) \
  X(CPLErrorReset)                \
  X(CPLGetLastErrorMsg)           \
  X(CPLPopErrorHandler)           \
  X(CPLPushErrorHandler)          \
  X(CPLQuietErrorHandler)         \
  X(GDALAllRegister)              \
  X(GDALClose)                    \
  X(GDALCreate)                   \
  X(GDALCreateCopy)               \
  X(GDALDatasetCommitTransaction) \
  X(GDALDatasetCreateLayer)       \
  X(GDALDatasetGetLayer)          \
  X(GDALDatasetGetLayerCount)     \
  X(GDALDatasetStartTransaction)  \
  X(GDALGetDriverByName)          \
  X(GDALGetGeoTransform)          \
  X(GDALGetRasterCount)           \
  X(GDALGetSpatialRef)            \
  X(GDALOpenEx)                   \
  X(GDALWarp)                     \
  X(GDALWarpAppOptionsFree)       \
  X(GDALWarpAppOptionsNew)        \
  X(OGR_FD_GetFieldIndex)         \
  X(OGR_F_Create)                 \
  X(OGR_F_Destroy)                \
  X(OGR_F_GetFieldAsString)       \
  X(OGR_F_GetGeometryRef)         \
  X(OGR_F_IsFieldSetAndNotNull)   \
  X(OGR_F_SetFID)                 \
  X(OGR_F_SetFieldDouble)         \
  X(OGR_F_SetFieldInteger)        \
  X(OGR_F_SetFieldNull)           \
  X(OGR_F_SetFieldString)         \
  X(OGR_F_SetGeometry)            \
  X(OGR_Fld_Create)               \
  X(OGR_Fld_Destroy)              \
  X(OGR_GT_Flatten)               \
  X(OGR_G_AddPoint)               \
  X(OGR_G_AddPoint_2D)            \
  X(OGR_G_CreateGeometry)         \
  X(OGR_G_DestroyGeometry)        \
  X(OGR_G_Empty)                  \
  X(OGR_G_GetGeometryCount)       \
  X(OGR_G_GetGeometryRef)         \
  X(OGR_G_GetGeometryType)        \
  X(OGR_G_GetPointCount)          \
  X(OGR_G_GetX)                   \
  X(OGR_G_GetY)                   \
  X(OGR_G_SetPoint)               \
  X(OGR_L_CreateFeature)          \
  X(OGR_L_CreateField)            \
  X(OGR_L_GetExtent)              \
  X(OGR_L_GetGeomType)            \
  X(OGR_L_GetLayerDefn)           \
  X(OGR_L_GetName)                \
  X(OGR_L_GetNextFeature)         \
  X(OGR_L_GetSpatialRef)          \
  X(OGR_L_ResetReading)           \
  X(OSRExportToWkt)               \
  X(OSRGetAuthorityCode)          \
  X(OSRGetAuthorityName)          \
  X(OSRIsGeographic)              \
  X(OSRNewSpatialReference)       \
  X(OSRRelease)                   \
  X(OSRSetAxisMappingStrategy)    \
  X(OSRSetFromUserInput)          \
  X(OSRSetLocalCS)                \
  X(VSIFree)                      \
  X(VSIGetMemFileBuffer)

/// Its functions, by its own names and types.
struct Gdal {
#define VERSINE_GDAL_MEMBER(name) decltype(&::name) name = nullptr;
  VERSINE_GDAL_FUNCTIONS(VERSINE_GDAL_MEMBER)
#undef VERSINE_GDAL_MEMBER
  // Of its C++ headers, which no file here includes.
  void (*RegisterOGRDXF)() = nullptr;
  void (*RegisterOGRGeoPackage)() = nullptr;
};

/// What a file needs: registering all of them takes longer than writing a small file.
enum class GdalDrivers { all, geopackage, dxf };

/// The functions of a library of this name. Fails when it, or one of them, is not there.
[[nodiscard]] Expected<Gdal> load_gdal(const char* library);

/// The library that this program was built for, loaded once, with these drivers registered. From any thread.
[[nodiscard]] Expected<const Gdal*> gdal(GdalDrivers drivers);

/// Calls a function of the table to free what another one gave.
template <auto Function>
struct GdalFree {
  const Gdal* gdal = nullptr;
  void operator()(void* handle) const { (gdal->*Function)(handle); }
};
using GdalDataset = std::unique_ptr<void, GdalFree<&Gdal::GDALClose>>;
using GdalCrs = std::unique_ptr<void, GdalFree<&Gdal::OSRRelease>>;
using GdalFeature = std::unique_ptr<void, GdalFree<&Gdal::OGR_F_Destroy>>;
using GdalField = std::unique_ptr<void, GdalFree<&Gdal::OGR_Fld_Destroy>>;
using GdalGeometry = std::unique_ptr<void, GdalFree<&Gdal::OGR_G_DestroyGeometry>>;

/// Makes an owned handle: `owned<GdalDataset>(*gdal, gdal->GDALOpenEx(...))`.
template <class Owner>
[[nodiscard]] Owner owned(const Gdal& gdal, void* handle) {
  return Owner(handle, {&gdal});
}

/// An empty file for layers; null when it cannot be made. The driver must be registered.
[[nodiscard]] GdalDataset create_gdal_file(const Gdal& gdal, const char* driver, const char* path);
/// A CRS from any text that GDAL knows, easting first; null: a project's own grid.
[[nodiscard]] GdalCrs make_gdal_crs(const Gdal& gdal, const char* definition);
[[nodiscard]] bool add_gdal_field(const Gdal& gdal, OGRLayerH layer, const char* name, OGRFieldType type);

}  // namespace versine::io
