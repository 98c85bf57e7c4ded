// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "adjustment.hpp"
#include "versine/stationing/control_network.hpp"
#include "versine/stationing/reduction.hpp"
#include "versine/stationing/result.hpp"

/// One target of a station: what it observes, and what an adjustment says of it.
namespace versine::stationing {

/// A target with the control point that it is taken for.
struct Candidate {
  const Target* target;
  const ControlPoint* point;
};

/// The target from the instrument, s-frame, m.
Eigen::Vector3d local(const Target& t);
/// Where the prism above a control point is, m-frame.
Eigen::Vector3d prism(const ControlPoint& point, double target_height);

/// The observation with the covariance of instrument, prism and control point.
Observation observe(const Target& t, const ControlPoint& point, const Pose& pose, const Instrument& instrument);

/// What the readings say about the place of a target, against its coordinates, and whether that is believable.
struct Discrepancy {
  Eigen::Vector3d offset;  ///< m-frame, m
  double test = 0.0;       ///< chi-square, 3 d.o.f.
};
/// For a target that the adjustment does not hold.
Discrepancy predict(const Candidate& c, const Adjustment& a, const Instrument& instrument);

/// Tests of the i-th target of an adjustment: T = v' R^-1 v with R the target's block of I - H. `detectable`: square
/// root of the non-centrality that the minimum detectable blunder is to have.
TargetResult test_target(const Candidate& c, const Observation& o, const Adjustment& a, std::size_t i,
                         double detectable);

}  // namespace versine::stationing
