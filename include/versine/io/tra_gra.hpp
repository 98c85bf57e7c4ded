// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "versine/design/assemble.hpp"

namespace versine::io {

/// The axis, cant and chainage of a Deutsche Bahn TRA file (Verm.esn, little-endian records of 78 bytes), audited.
/// Cant is given in mm for the outer rail; a negative one is adverse. The stations of a track's own file count along
/// that track; those of a stationing line's file are the railway's mileage. Fails with the record's number when the
/// file is cut short or holds a number that can't be.
[[nodiscard]] Expected<design::RawAlignment> read_tra(const std::filesystem::path& path);

/// A point of a GRA file: a gradient change at a mileage of the stationing line.
struct GraPoint {
  double mileage = 0.0;  ///< m
  double height = 0.0;   ///< m
  double radius = 0.0;   ///< m; zero: none. The sign of the file is dropped: it follows from the gradients
  double tangent = 0.0;  ///< m, as the file states it
};
/// The gradients of a DB GRA file (records of 36 bytes), in the file's order.
[[nodiscard]] Expected<std::vector<GraPoint>> read_gra(const std::filesystem::path& path);

/// A track with its profile. The heights of `gra` lie at mileages of the stationing line; each is carried to the track
/// perpendicular to that line. Without `stationing` the track's own stations must be the mileage.
[[nodiscard]] Expected<design::Imported> read_tra_gra(const std::filesystem::path& tra,
                                                      const std::optional<std::filesystem::path>& gra,
                                                      const std::optional<std::filesystem::path>& stationing,
                                                      const design::AuditLimits& limits = {});

}  // namespace versine::io
