// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "versine/core/error.hpp"
#include "versine/network/source.hpp"

namespace versine::io {

/// Reads GeoJSON networks that say themselves which way a wheel can take; `.zst` and `.gz` are unpacked. Two layouts,
/// told apart by their features:
///  - netelements (LineStrings with `id`) and netrelations (`type` "netrelation", `netelementA`, `netelementB`,
///    `positionOnA`, `positionOnB`, `navigability` both, none, AB or BA), as Infrabel publishes;
///  - branches (LineStrings with `id`, `length_m`) and directed connections without geometry (`type` "connection",
///    `from`, `from_direction` "0-100" or "100-0", `to`, `to_percent`, `to_direction`), as ProRail's network.
/// The CRS is the collection's `crs` member (EPSG only), else WGS84. Fails, naming file and feature, on what is no
/// such file; a file of plain lines is read too, without connections.
[[nodiscard]] Expected<network::NetworkSource> read_labelled_network(const std::filesystem::path& path);

}  // namespace versine::io
