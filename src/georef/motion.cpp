// SPDX-License-Identifier: Apache-2.0
#include "motion.hpp"

#include <cmath>

namespace versine::georef {

MotionTable::MotionTable(const MotionModel& model, double T, double correlation_time) {
  // One step: s' = s + T a, d' = d + T s + T^2/2 a (eq. 7), a Gauss-Markov; white noise of density `white` on the
  // acceleration, as in eq. 8, held over the step.
  const double f = std::exp(-T / model.time), w = model.white * model.white / T, g = 0.5 * T * T;
  Motion one;
  one.F << 1, T, g, 0, 1, T, 0, 0, f;
  one.Q << g * g * w, g * T * w, 0, g * T * w, T * T * w, 0, 0, 0, model.sigma * model.sigma * (1.0 - f * f);
  one.decay = std::exp(-T / correlation_time);
  table_ = {Motion{}, one};
}

const Motion& MotionTable::steps(std::int64_t n) {
  while (static_cast<std::int64_t>(table_.size()) <= n) {
    const Motion &one = table_[1], &last = table_.back();
    Motion next;
    next.F = one.F * last.F;
    next.Q = one.F * last.Q * one.F.transpose() + one.Q;
    next.decay = one.decay * last.decay;
    table_.push_back(next);
  }
  return table_[static_cast<std::size_t>(n)];
}

}  // namespace versine::georef
