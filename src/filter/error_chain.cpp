// SPDX-License-Identifier: Apache-2.0
#include "versine/filter/error_chain.hpp"

#include <algorithm>
#include <stdexcept>

namespace versine::filter {

void ErrorChain::push_back(Time time, Matrix covariance, Matrix gain) {
  if (covariance.rows() != covariance.cols() || covariance.rows() < 6 ||
      (gain.size() > 0 && (gain.rows() != covariance.rows() || gain.cols() != covariance.rows())) ||
      (!empty() && (!(time_.back() < time) || covariance_.back().rows() != covariance.rows()))) {
    throw std::invalid_argument("ErrorChain: epochs in order of time, square matrices of one dimension");
  }
  time_.push_back(time);
  covariance_.push_back(std::move(covariance));
  gain_.push_back(std::move(gain));
}

std::size_t ErrorChain::index_at(Time t) const {
  const auto it = std::upper_bound(time_.begin(), time_.end(), t);
  return it == time_.begin() ? 0 : static_cast<std::size_t>(it - time_.begin()) - 1;
}

Eigen::Matrix<double, 6, 6> ErrorChain::cross_covariance(std::size_t i, std::size_t j) const {
  if (i > j) return cross_covariance(j, i).transpose();
  // Six rows at a time from the left: 6 n^2 instead of n^3 a step.
  Eigen::MatrixXf rows = Eigen::MatrixXf::Identity(6, covariance_[i].rows());
  for (std::size_t k = i; k < j; ++k) {
    if (gain_[k].size() == 0) return Eigen::Matrix<double, 6, 6>::Zero();
    rows = (rows * gain_[k]).eval();
  }
  return (rows * covariance_[j]).leftCols<6>().cast<double>();
}

}  // namespace versine::filter
