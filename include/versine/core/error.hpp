// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <tl/expected.hpp>

namespace versine {

/// Why something data-dependent failed, complete enough that the user can mend it without reading code.
/// Empty members are unknown or do not apply.
struct Error {
  std::string file;      ///< path as the user gave it
  std::size_t line = 0;  ///< 1-based line or record; 0: none
  std::string field;     ///< column, key, layer or stage
  std::string found;     ///< what was there ("'1.2x' is not a number")
  std::string expected;  ///< what should be there ("a number in rad/s")
  std::string advice;    ///< what to do next ("remove the letter, or name the column's unit in [columns]")

  /// One or two lines: `imu.csv:17: gyro_x_radps: found ..., expected ...\n  advice`.
  [[nodiscard]] std::string message() const;
};

template <class T>
using Expected = tl::expected<T, Error>;

/// `return fail({.file = path, .found = "..."});`
inline tl::unexpected<Error> fail(Error error) { return tl::unexpected<Error>(std::move(error)); }

}  // namespace versine
