// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "versine/core/time.hpp"

namespace versine::filter {

/// Joint distribution of smoothed errors over a run, as a Markov chain backwards in time:
/// `e_k = A_k e_{k+1} + w_k`, `cov(e_k) = P_k`, with A_k the smoother gain (Chen 2018 eq. 13). It answers what
/// neighbouring epochs share: a versine's sigma needs `cov(e_i, e_j)`, not the two sigmas alone.
/// Rows 0-2 of an error are position (n-frame, m), rows 3-5 attitude (phi-angle in n, rad), the rest whatever else the
/// filter estimates. float keeps 7 digits: enough for a sigma, and half the memory.
class ErrorChain {
 public:
  using Matrix = Eigen::MatrixXf;

  /// Appends epoch k in order of time. `gain` is A_k (to the next epoch) and is empty at the end of a segment: errors
  /// of different segments are independent. REQUIRES square matrices of the same dimension throughout.
  void push_back(Time time, Matrix covariance, Matrix gain);

  [[nodiscard]] std::size_t size() const { return time_.size(); }
  [[nodiscard]] bool empty() const { return time_.empty(); }
  [[nodiscard]] Time time(std::size_t k) const { return time_[k]; }
  [[nodiscard]] const Matrix& covariance(std::size_t k) const { return covariance_[k]; }
  [[nodiscard]] const Matrix& gain(std::size_t k) const { return gain_[k]; }
  /// Index of the last epoch at or before t; 0 when there is none. REQUIRES !empty().
  [[nodiscard]] std::size_t index_at(Time t) const;

  /// Rows 0-5 of cov(e_i, e_j): A_i ... A_{j-1} P_j for i <= j, its transpose for i > j; zero across segments.
  [[nodiscard]] Eigen::Matrix<double, 6, 6> cross_covariance(std::size_t i, std::size_t j) const;

 private:
  std::vector<Time> time_;
  std::vector<Matrix> covariance_, gain_;
};

}  // namespace versine::filter
