// SPDX-License-Identifier: Apache-2.0
#include "command.hpp"

namespace versine::cli {
void add_init(CLI::App&, int&) {}
void add_check(CLI::App&, int&) {}
}  // namespace versine::cli
