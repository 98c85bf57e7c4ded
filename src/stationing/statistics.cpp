// SPDX-License-Identifier: Apache-2.0
#include "statistics.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>

namespace versine::stationing {

double chi_square_quantile(int degrees, double alpha) {
  return boost::math::quantile(boost::math::complement(boost::math::chi_squared(degrees), alpha));
}

double noncentrality_root(double alpha, double power) {
  const boost::math::normal normal;
  return boost::math::quantile(boost::math::complement(normal, 0.5 * alpha)) + boost::math::quantile(normal, power);
}

}  // namespace versine::stationing
