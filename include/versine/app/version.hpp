// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace versine::app {

/// Version of Versine as in the build, "0.1.0".
[[nodiscard]] std::string version();

}  // namespace versine::app
