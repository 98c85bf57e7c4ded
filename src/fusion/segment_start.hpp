// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "versine/fusion/ins_state.hpp"

namespace versine::fusion::detail {

/// A piece of the run without gaps: samples begin <= i < end, from `from` (the start of the first interval).
struct Segment {
  std::size_t begin = 0, end = 0;
  Time from, to;
};
[[nodiscard]] std::vector<Segment> segments_of(const AidedInsInput& input, const AidedInsOptions& options);

/// Where a filter begins.
struct Start {
  InsEstimate estimate;
  Eigen::MatrixXd covariance;  ///< of all states; that of the parameters comes from the segment before
  inertial::InitialAlignment alignment;
  bool standing = false;
};

/// What the segment before left.
struct Previous {
  InsEstimate estimate;
  Eigen::MatrixXd covariance;
};

/// Position, velocity and attitude at the start of a segment from whatever tells them (`run_aided_ins`).
[[nodiscard]] Expected<Start> start_of(const Segment& segment, const AidedInsInput& input,
                                       const AidedInsOptions& options, const InsLayout& layout,
                                       const std::vector<inertial::Interval>& standstills,
                                       const std::optional<Previous>& previous);

}  // namespace versine::fusion::detail
