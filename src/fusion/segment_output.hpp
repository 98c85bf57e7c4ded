// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "run_segment.hpp"

namespace versine::fusion::detail {

/// Error and covariance at a step's end, as much as the output needs.
struct Node {
  Eigen::Matrix<double, 9, 1> after = Eigen::Matrix<double, 9, 1>::Zero(), before = after;
  geodesy::Covariance3 position, velocity, attitude;
};

template <class Matrix>
void set_covariance(Node& node, const Matrix& P) {
  node.position = geodesy::Covariance3::from(P.template block<3, 3>(0, 0));
  node.velocity = geodesy::Covariance3::from(P.template block<3, 3>(3, 3));
  node.attitude = geodesy::Covariance3::from(P.template block<3, 3>(6, 6));
}

/// Writes a trajectory at the wanted IMU samples: walks from each waypoint as the filter did and takes off the error,
/// which between two steps runs straight from the one to the other.
void write_trajectory(const RunContext& c, const Segment& segment, const std::deque<Waypoint>& waypoints,
                      const std::vector<Node>& nodes, std::int32_t number, geodesy::Trajectory& out);

/// Values of the parameters in the order of their names.
[[nodiscard]] Eigen::VectorXf parameter_values(const InsEstimate& e, const InsLayout& l);

/// Position and attitude first, as ErrorChain wants them.
[[nodiscard]] std::vector<int> chain_order(int n);

}  // namespace versine::fusion::detail
