// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "versine/report/drawing.hpp"

namespace versine::report {

/// The drawing as an `<svg>` element: no script, no external reference. Coordinates are whole twentieths of a
/// millimetre, lines relative, which keeps a page of strips below 100 kB. `standalone` adds the size for a file of its
/// own.
[[nodiscard]] std::string to_svg(const Drawing& drawing, bool standalone = false);

/// With &, <, >, " written for XML; control characters that XML forbids become blanks.
[[nodiscard]] std::string escaped(const std::string& text);

}  // namespace versine::report
