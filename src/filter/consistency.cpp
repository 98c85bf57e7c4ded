// SPDX-License-Identifier: Apache-2.0
#include "versine/filter/consistency.hpp"

#include <boost/math/distributions/chi_squared.hpp>

namespace versine::filter {

double chi_square_quantile(double probability, double dof) {
  return boost::math::quantile(boost::math::chi_squared(dof), probability);
}

Bounds mean_chi_square_bounds(std::size_t count, double dof, double probability) {
  const double total = static_cast<double>(count) * dof, tail = 0.5 * (1.0 - probability);
  const boost::math::chi_squared distribution(total);
  return {boost::math::quantile(distribution, tail) / total,
          boost::math::quantile(boost::math::complement(distribution, tail)) / total};
}

Gate::Gate(double false_alarm) {
  for (int rows = 1; rows <= max_rows; ++rows) {
    threshold_[static_cast<std::size_t>(rows)] =
        boost::math::quantile(boost::math::complement(boost::math::chi_squared(rows), false_alarm));
  }
}

InnovationMonitor::InnovationMonitor(int length, double false_alarm)
    : length_(static_cast<std::size_t>(length)), gate_(false_alarm) {}

bool InnovationMonitor::add(const Eigen::Ref<const Eigen::VectorXd>& whitened) {
  if (!window_.empty() && window_.front().size() != whitened.size()) window_.clear();
  if (window_.size() < length_) {
    window_.emplace_back(whitened);
    next_ = 0;
  } else {
    window_[next_] = whitened;
    next_ = (next_ + 1) % length_;
  }
  if (window_.size() < length_) return false;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(whitened.size());
  for (const auto& w : window_) sum += w;
  statistic_ = sum.squaredNorm() / static_cast<double>(length_);
  return !(statistic_ <= gate_.threshold(static_cast<int>(whitened.size())));
}

}  // namespace versine::filter
