// SPDX-License-Identifier: Apache-2.0
#include "run_segment.inl.hpp"

namespace versine::fusion::detail {
template Expected<Previous> run_segment<29>(const RunContext&, const Segment&, const Start&, std::int32_t);
}
