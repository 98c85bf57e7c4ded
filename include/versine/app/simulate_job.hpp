// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/app/job_kinds.hpp"

namespace versine::app {

extern const JobKind simulate_job;

}  // namespace versine::app
