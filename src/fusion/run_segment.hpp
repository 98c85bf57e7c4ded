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
template <int N>
[[nodiscard]] Expected<Previous> run_segment(const RunContext& context, const Segment& segment, const Start& start,
                                             std::int32_t number);

extern template Expected<Previous> run_segment<23>(const RunContext&, const Segment&, const Start&, std::int32_t);
extern template Expected<Previous> run_segment<25>(const RunContext&, const Segment&, const Start&, std::int32_t);
extern template Expected<Previous> run_segment<26>(const RunContext&, const Segment&, const Start&, std::int32_t);
extern template Expected<Previous> run_segment<29>(const RunContext&, const Segment&, const Start&, std::int32_t);
extern template Expected<Previous> run_segment<Eigen::Dynamic>(const RunContext&, const Segment&, const Start&,
                                                               std::int32_t);

}  // namespace versine::fusion::detail
