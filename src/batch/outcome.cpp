// SPDX-License-Identifier: Apache-2.0
#include "versine/batch/outcome.hpp"

#include <algorithm>
#include <array>

namespace versine::batch {

Exit graver(Exit a, Exit b) {
  static constexpr std::array order{Exit::done,  Exit::rejected,      Exit::incomplete, Exit::failed, Exit::again,
                                    Exit::usage, Exit::configuration, Exit::changed,    Exit::differs};
  const auto rank = [&](Exit e) { return std::find(order.begin(), order.end(), e); };
  return rank(a) < rank(b) ? b : a;
}

}  // namespace versine::batch
