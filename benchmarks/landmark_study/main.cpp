// SPDX-License-Identifier: Apache-2.0
// Landmark dead reckoning on simulated recordings with known truth; prints the tables of docs/planning.md.
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>

#include "studies.hpp"
#include "versine/core/units.hpp"

int main(int argc, char** argv) {
  using namespace versine;
  using units::mm;
  const auto number = [&](int i, double otherwise) { return argc > i ? std::atof(argv[i]) : otherwise; };
  if (argc > 1 && std::strcmp(argv[1], "groups") == 0) return study::groups(static_cast<int>(number(2, 50)));
  if (argc > 1 && std::strcmp(argv[1], "tunnel") == 0) {
    return study::tunnel(static_cast<std::uint64_t>(number(2, 1)), number(3, 800.0), number(4, 100.0) * mm,
                         number(5, 60.0), number(6, 0.1) * 1e-3, number(7, 1.0));
  }
  if (argc > 1 && std::strcmp(argv[1], "validity") == 0) {
    return study::validity(number(2, 0.1) * 1e-3, static_cast<int>(number(3, 3)));
  }
  fmt::print(stderr,
             "usage: {} groups [SEEDS] | tunnel [SEED [RADIUS_M [CANT_MM [SPACING_M [MOUNTING_MRAD [ROUGHNESS]]]]]] |\n"
             "       validity [MOUNTING_MRAD [SEEDS]]\n",
             argv[0]);
  return 2;
}
