// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

#include "versine/core/error.hpp"
#include "versine/core/time.hpp"

namespace versine::gnss {

/// What must be known of a RINEX 2 or 3 file before it is processed. RTKLIB itself reads the data.
struct RinexScan {
  enum class Kind { observation, navigation };
  Kind kind = Kind::observation;
  double version = 0.0;
  Time first, last;  ///< epochs of observations, or reference times of ephemerides; GPS time (or the file's)
  std::size_t epochs = 0;
  double interval = 0.0;                       ///< most frequent spacing, s; observations only
  std::optional<Eigen::Vector3d> approximate;  ///< APPROX POSITION XYZ, m; none when it is zero
  std::string marker;
};

/// What a file of raw GNSS data is, by its first bytes.
enum class RawKind { rinex, hatanaka, ublox, novatel, unknown };
[[nodiscard]] RawKind raw_kind(std::string_view content);

/// Header and epochs of a RINEX file. Fails when there is no header, no end of header or no epoch.
[[nodiscard]] Expected<RinexScan> scan_rinex(std::string_view text, const std::string& name);

}  // namespace versine::gnss
