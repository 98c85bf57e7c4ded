// SPDX-License-Identifier: Apache-2.0
#include "versine/filter/error_chain.hpp"

#include <gtest/gtest.h>

namespace versine::filter {
namespace {

TEST(ErrorChain, CrossCovarianceOfARandomWalkTiedAtItsEnd) {
  // e_k = e_{k+1} + w_k with var(w) = 1 and e_n = 0 at the end: cov(e_i, e_j) = min(n - i, n - j).
  ErrorChain chain;
  const int n = 10;
  for (int k = 0; k < n; ++k) {
    chain.push_back({k * 1000}, Eigen::MatrixXf::Identity(7, 7) * float(n - k), Eigen::MatrixXf::Identity(7, 7));
  }
  EXPECT_NEAR(chain.cross_covariance(2, 7)(0, 0), 3.0, 1e-6);
  EXPECT_NEAR(chain.cross_covariance(7, 2)(4, 4), 3.0, 1e-6);
  EXPECT_EQ(chain.index_at({2500}), 2u);
  EXPECT_THROW(chain.push_back({0}, Eigen::MatrixXf::Identity(7, 7), {}), std::invalid_argument);
}

TEST(ErrorChain, SegmentsAreIndependent) {
  ErrorChain chain;
  chain.push_back({0}, Eigen::MatrixXf::Identity(6, 6), {});
  chain.push_back({1}, Eigen::MatrixXf::Identity(6, 6), {});
  EXPECT_EQ(chain.cross_covariance(0, 1).norm(), 0.0);
}

}  // namespace
}  // namespace versine::filter
