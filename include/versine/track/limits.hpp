// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace versine::track {

/// Limits of one quantity at one level: the value is exceeded below `low` or above `high`.
struct Limit {
  std::string column;  ///< name in Geometry; '*' stands for any part ("alignment_*_d1")
  std::string level;   ///< one of LimitProfile::levels
  double low = 0.0;    ///< SI
  double high = 0.0;   ///< SI
  std::string source;  ///< where the number was read; "[M]" when not in the standard itself
};

/// Limit of a standard deviation over a section.
struct SectionLimit {
  std::string column;
  std::string level;
  double sigma = 0.0;  ///< SI
  std::string source;
};

/// Bounds of quality classes by the standard deviation of one quantity: the first class whose bound is not exceeded.
struct QualityClasses {
  std::string column;
  std::vector<std::string> names;  ///< one more than bounds
  std::vector<double> bounds;      ///< SI, increasing
  std::string source;
};

/// What is allowed at up to a speed.
struct SpeedClass {
  double speed = 0.0;  ///< m/s, inclusive
  std::vector<Limit> limits;
  std::vector<SectionLimit> section_limits;
  std::vector<QualityClasses> classes;
  double tqi = 0.0;  ///< management value of the TQI, in mm as everywhere; 0: none
};

/// A file of limits (data/limits/*.toml, or a user's own): never constants in the code.
struct LimitProfile {
  std::string name;
  std::string source;
  std::vector<std::string> levels;  ///< in order of severity: "AL", "IL", "IAL"
  double section = 200.0;           ///< m
  /// Columns whose sigmas add up to the TQI; empty: none.
  std::vector<std::string> tqi_columns;
  /// Weights of CoSD = sqrt(w_AL s_AL^2 + w_G s_G^2 + w_CL s_CL^2 + w_LL s_LL^2); empty: none.
  std::vector<double> cosd_weights;
  std::vector<SpeedClass> speeds;  ///< increasing
};

/// Whether a name matches a pattern with '*'.
[[nodiscard]] bool matches(const std::string& pattern, const std::string& name);

}  // namespace versine::track
