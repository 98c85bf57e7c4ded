// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/app/job_kinds.hpp"

namespace versine::app {

extern const JobKind geometry_job;
extern const JobKind calibrate_job;

}  // namespace versine::app
