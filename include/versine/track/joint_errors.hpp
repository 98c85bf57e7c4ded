// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "versine/filter/error_chain.hpp"

namespace versine::track {

/// How the error of one number depends on the trajectory's error at a node: rows 0-2 position, 3-5 attitude.
using ErrorRow = Eigen::Matrix<float, 6, 1>;

/// The errors of a trajectory at nodes along the track, with what neighbouring nodes share. Neighbouring errors of a
/// smoothed trajectory are almost equal, so a versine is known far better than its three points: its variance needs
/// `cov(e_i, e_j) = A_i ... A_{j-1} P_j`. For all pairs of one distance the window's products are formed by a queue of
/// two stacks, one matrix product a node whatever the distance: linear in the length of the run.
class JointErrors {
 public:
  /// `times`: when the run was at each node; strictly increasing or strictly decreasing. REQUIRES !chain.empty().
  JointErrors(const filter::ErrorChain& chain, std::span<const Time> times);

  [[nodiscard]] std::size_t size() const { return covariance_.size(); }

  struct Term {
    std::ptrdiff_t node = 0;  ///< relative to the node that the number belongs to
    double weight = 1.0;
  };
  /// Variance, at each node i, of sum over terms of weight * rows[i + node] . e(i + node); NaN where a term leaves
  /// the run. Keeps the covariances of each distance for the next call.
  [[nodiscard]] std::vector<double> variance(std::span<const Term> terms, std::span<const ErrorRow> rows);
  /// The same for a filter: weights of the nodes from -m to m about each node, symmetric (2 m + 1 of them). At every
  /// `every`-th node; NaN elsewhere and where the filter leaves the run. Several kinds of rows go in one pass, since
  /// each pass carries vectors along the chain: linear in the number of weights.
  [[nodiscard]] std::vector<std::vector<double>> filtered_variance(std::span<const float> weights,
                                                                   std::span<const std::span<const ErrorRow>> rows,
                                                                   std::size_t every) const;

 private:
  using Matrix6 = Eigen::Matrix<float, 6, 6>;
  [[nodiscard]] const std::vector<Matrix6>& at_distance(std::size_t nodes);

  bool reversed_ = false;
  std::vector<Eigen::MatrixXf> covariance_, gain_;  // in order of time; gain_[k] leads from node k to k + 1
  std::map<std::size_t, std::vector<Matrix6>> distance_;
};

}  // namespace versine::track
