// SPDX-License-Identifier: Apache-2.0
#include "run_segment.inl.hpp"

namespace versine::fusion::detail {
VERSINE_RUN_SEGMENT(28, filter::moving_with_path);
}
