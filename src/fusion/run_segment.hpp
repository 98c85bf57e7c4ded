// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "backward.hpp"
#include "forward.hpp"

namespace versine::fusion::detail {

/// Everything that the parts of a run share.
struct RunContext {
  const AidedInsInput& input;
  const AidedInsOptions& options;
  const InsLayout& layout;
  const std::vector<inertial::Interval>& standstills;
  Judge& judge;
  AidedInsResult& result;
  Progress& progress;
  RunWatch* watch;  ///< nullptr: nobody looks on
};

/// Filter, smoother and output of one segment; appends to the result. Returns what it leaves to the next segment.
template <int N, int M>
[[nodiscard]] Expected<Previous> run_segment(const RunContext& context, const Segment& segment, const Start& start,
                                             std::int32_t number);

#define VERSINE_RUN_SEGMENT(N, M) \
  template Expected<Previous> run_segment<N, M>(const RunContext&, const Segment&, const Start&, std::int32_t)
extern VERSINE_RUN_SEGMENT(23, filter::moving);
extern VERSINE_RUN_SEGMENT(25, filter::moving);
extern VERSINE_RUN_SEGMENT(26, filter::moving);
extern VERSINE_RUN_SEGMENT(29, filter::moving);
extern VERSINE_RUN_SEGMENT(Eigen::Dynamic, filter::moving);
extern VERSINE_RUN_SEGMENT(25, filter::moving_with_path);
extern VERSINE_RUN_SEGMENT(28, filter::moving_with_path);
extern VERSINE_RUN_SEGMENT(Eigen::Dynamic, filter::moving_with_path);

}  // namespace versine::fusion::detail
