// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

/// Each prints a table of docs/planning.md and returns the program's exit code.
namespace versine::study {

/// Six runs of 120 m as in Jiang 2017 section 6.2.
int groups(int seeds);
/// 5 km with curves and cant, beside the aided INS. Metres, radians.
int tunnel(std::uint64_t seed, double radius, double cant, double spacing, double mounting, double roughness);
/// The same line tighter and tighter: the reduced model's own error.
int validity(double mounting, int seeds);

}  // namespace versine::study
