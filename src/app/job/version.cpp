// SPDX-License-Identifier: Apache-2.0
#include "versine/app/version.hpp"

namespace versine::app {

std::string version() {
  return VERSINE_VERSION;
}

}  // namespace versine::app
