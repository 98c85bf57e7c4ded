// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/app/geometry_config.hpp"
#include "versine/io/fastenings_csv.hpp"

namespace versine::app {

/// Fine adjustment of a slab track: the reference rail first, then the other one through gauge and cross level. At the
/// detected sleepers, `at_sleepers`, or every `spacing` where there are none. Fails without a design.
[[nodiscard]] Expected<io::FasteningPlans> plan_slab(const FasteningConfig& config, const track::Geometry& geometry,
                                                     const track::Geometry* at_sleepers);
[[nodiscard]] std::string slab_json(const io::FasteningPlans& plans);
[[nodiscard]] std::string slab_text(const io::FasteningPlans& plans);

}  // namespace versine::app
