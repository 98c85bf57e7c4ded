// SPDX-License-Identifier: Apache-2.0
#include "versine/track/sleepers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace versine::track {
namespace {

/// Otsu's threshold of sorted values: the split with the largest variance between the classes.
double threshold(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  double total = 0.0, sum = 0.0, best = -1.0, where = x.front();
  for (const double v : x) total += v;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    sum += x[i];
    const double k = double(i + 1), d = sum / k - (total - sum) / (n - k), between = k * (n - k) * d * d;
    if (between > best) {
      best = between;
      where = 0.5 * (x[i] + x[i + 1]);
    }
  }
  return where;
}

std::vector<double> detect(std::span<const double> s, std::span<const double> range) {
  std::vector<double> found;
  constexpr double piece = 50.0;
  double from = std::numeric_limits<double>::quiet_NaN(), to = from;
  const auto close = [&] {
    if (to - from > 0.05 && to - from < 0.6) found.push_back(0.5 * (from + to));  // narrower is a spike
    from = std::numeric_limits<double>::quiet_NaN();
  };
  for (std::size_t a = 0; a < s.size();) {
    std::size_t b = a;
    std::vector<double> values;
    for (; b < s.size() && s[b] < s[a] + piece; ++b) {
      if (std::isfinite(range[b])) values.push_back(range[b]);
    }
    const double limit = values.size() > 20 ? threshold(std::move(values)) : -1.0;
    for (; a < b; ++a) {
      if (range[a] < limit) {
        if (std::isnan(from)) from = s[a];
        to = s[a];
      } else if (!std::isnan(from) && std::isfinite(range[a])) {
        close();
      }
    }
  }
  close();
  return found;
}

double local_spacing(const std::vector<double>& at, std::size_t i, const SleeperOptions& o) {
  std::vector<double> d;
  const std::size_t from = i > 15 ? i - 15 : 0, to = std::min(at.size() - 1, i + 15);
  for (std::size_t k = from; k < to; ++k) {
    const double v = at[k + 1] - at[k];
    if (v >= o.smallest_spacing && v <= o.largest_spacing) d.push_back(v);
  }
  if (d.empty()) return 0.6;
  const auto middle = d.begin() + static_cast<std::ptrdiff_t>(d.size() / 2);
  std::nth_element(d.begin(), middle, d.end());
  return *middle;
}

}  // namespace

SleeperResult find_sleepers(std::span<const double> s, std::span<const double> range, const SleeperOptions& options) {
  SleeperResult out;
  std::vector<double> found = detect(s, range);
  // False ones: when removing a detection leaves its neighbours one spacing apart, it stood between two sleepers.
  std::vector<double> kept;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double spacing = local_spacing(found, i, options);
    if (!kept.empty() && i + 1 < found.size()) {
      const double across = found[i + 1] - kept.back(), before = found[i] - kept.back();
      const bool near =
          before < (1.0 - options.tolerance) * spacing && across - before < (1.0 - options.tolerance) * spacing;
      if (near && across < (1.0 + options.tolerance) * spacing) {
        ++out.rejected;
        continue;
      }
    }
    kept.push_back(found[i]);
  }
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (i > 0) {
      const double spacing = local_spacing(kept, i, options), gap = kept[i] - kept[i - 1];
      const double n = std::round(gap / spacing);
      if (n >= 2 && n <= 4 && std::abs(gap - n * spacing) < options.tolerance * spacing * n) {
        for (int k = 1; k < static_cast<int>(n); ++k) {
          out.sleepers.push_back({kept[i - 1] + gap * k / n, true});
          ++out.mended;
        }
      }
    }
    out.sleepers.push_back({kept[i], false});
  }
  return out;
}

}  // namespace versine::track
