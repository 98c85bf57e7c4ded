// SPDX-License-Identifier: Apache-2.0
#include "versine/filter/linearized.hpp"

#include <Eigen/Cholesky>

namespace versine::filter {

bool whiten(Linearized& l) {
  const Eigen::LLT<decltype(l.R)> llt(l.R);
  if (llt.info() != Eigen::Success) return false;
  llt.matrixL().solveInPlace(l.z);
  llt.matrixL().solveInPlace(l.H);
  return true;
}

}  // namespace versine::filter
