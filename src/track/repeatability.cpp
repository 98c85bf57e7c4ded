// SPDX-License-Identifier: Apache-2.0
#include "versine/track/repeatability.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "versine/core/numbers.hpp"
#include "versine/track/versine.hpp"

namespace versine::track {
namespace {

/// Correlation of two signals over [a, b) with the second one `lag` points on.
struct Sums {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  void add(double u, double v) {
    n += 1;
    x += u;
    y += v;
    xx += u * u;
    yy += v * v;
    xy += u * v;
  }
  [[nodiscard]] double correlation() const {
    const double d = (n * xx - x * x) * (n * yy - y * y);
    return d > 0.0 ? (n * xy - x * y) / std::sqrt(d) : nan;
  }
};

double correlation(const std::vector<double>& a, const std::vector<double>& b, std::ptrdiff_t offset, std::size_t from,
                   std::size_t to) {
  Sums s;
  for (std::size_t i = from; i < to; ++i) {
    const std::ptrdiff_t k = static_cast<std::ptrdiff_t>(i) + offset;
    if (k < 0 || k >= static_cast<std::ptrdiff_t>(b.size())) continue;
    const double v = b[static_cast<std::size_t>(k)];
    if (std::isfinite(a[i]) && std::isfinite(v)) s.add(a[i], v);
  }
  return s.n > 0.5 * double(to - from) ? s.correlation() : nan;
}

}  // namespace

std::vector<MileageShift> find_shifts(const Geometry& reference, const Geometry& run, const ShiftOptions& options) {
  if (std::abs(reference.step - run.step) > 1e-9) throw std::invalid_argument("find_shifts: one step");
  std::vector<MileageShift> out;
  if (reference.size() == 0 || run.size() == 0) return out;
  std::vector<const char*> names;
  for (const char* name :
       {"gauge", "twist_3m", "versine_lateral_left_10m", "versine_vertical_left_10m", "versine_vertical_right_10m"}) {
    if (reference.find(name) != nullptr && run.find(name) != nullptr) names.push_back(name);
  }
  const auto base =
      static_cast<std::ptrdiff_t>(std::llround((reference.mileage.front() - run.mileage.front()) / run.step));
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(options.largest / run.step));
  const auto piece = static_cast<std::size_t>(options.window / run.step);
  for (std::size_t a = 0; a + piece <= reference.size(); a += piece) {
    std::vector<double> r;
    for (std::ptrdiff_t lag = -reach; lag <= reach; ++lag) {
      double sum = 0, n = 0;
      for (const char* name : names) {
        const double c = correlation(reference.at(name).value, run.at(name).value, base + lag, a, a + piece);
        if (std::isfinite(c)) {
          sum += c;
          n += 1;
        }
      }
      r.push_back(n > 0 ? sum / n : -1.0);
    }
    const auto best = std::max_element(r.begin(), r.end());
    const auto k = best - r.begin();
    if (*best < options.weakest || k == 0 || k + 1 == static_cast<std::ptrdiff_t>(r.size())) continue;
    const double left = *(best - 1), right = *(best + 1), bend = left - 2.0 * *best + right;
    const double part = bend < 0.0 ? 0.5 * (left - right) / bend : 0.0;
    // The run shows at index i + base + lag what the reference shows at i.
    out.push_back({reference.mileage[a + piece / 2], -(double(k - reach) + part) * run.step, *best});
  }
  return out;
}

Geometry aligned_to(const Geometry& reference, const Geometry& run, std::span<const MileageShift> shifts) {
  const auto shift_at = [&](double m) {
    if (shifts.empty()) return 0.0;
    const auto it = std::lower_bound(shifts.begin(), shifts.end(), m,
                                     [](const MileageShift& s, double x) { return s.mileage < x; });
    if (it == shifts.begin()) return it->shift;
    if (it == shifts.end()) return shifts.back().shift;
    const MileageShift &a = *std::prev(it), &b = *it;
    return a.shift + (b.shift - a.shift) * (m - a.mileage) / (b.mileage - a.mileage);
  };
  Geometry out = reference;
  out.columns.clear();
  out.origin = run.origin;
  std::vector<double> index;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double m = reference.mileage[i] - shift_at(reference.mileage[i]);
    const double k = (m - run.mileage.front()) / run.step;
    index.push_back(k);
    const auto near = static_cast<std::size_t>(std::clamp(std::round(k), 0.0, double(run.size() - 1)));
    out.flags[i] = run.flags[near];
    out.time[i] = run.time[near];
  }
  for (const Column& c : run.columns) {
    Column& o = out.add(c.name, c.unit, c.scale, c.description, !c.sigma.empty());
    for (std::size_t i = 0; i < index.size(); ++i) {
      o.value[i] =
          grid_value(c.value, std::abs(index[i] - std::round(index[i])) < 1e-6 ? std::round(index[i]) : index[i]);
      if (!c.sigma.empty() && index[i] >= 0.0 && index[i] <= double(c.sigma.size() - 1)) {
        o.sigma[i] = c.sigma[static_cast<std::size_t>(std::llround(index[i]))];
      }
    }
  }
  return out;
}

std::vector<Repeatability> compare(const Geometry& reference, const Geometry& aligned) {
  std::vector<Repeatability> out;
  for (const Column& c : reference.columns) {
    const Column* other = aligned.find(c.name);
    if (other == nullptr || c.unit == "m") continue;
    std::vector<double> d;
    double z2 = 0, nz = 0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
      if (((reference.flags[i] | aligned.flags[i]) & (band_edge | no_gauge | no_trajectory)) != 0) continue;
      const double v = other->value[i] - c.value[i];
      if (!std::isfinite(v)) continue;
      d.push_back(v);
      if (c.sigma.empty() || other->sigma.empty()) continue;
      const double s = std::hypot(c.sigma[i], other->sigma[i]);
      if (s > 0.0) {
        z2 += v * v / (s * s);
        nz += 1;
      }
    }
    Repeatability r{.column = c.name, .count = d.size()};
    if (d.empty()) continue;
    for (const double v : d) {
      r.mean += v;
      r.rms += v * v;
    }
    r.mean /= double(d.size());
    r.rms = std::sqrt(r.rms / double(d.size()));
    for (double& v : d) v = std::abs(v - r.mean);
    const auto at = d.begin() + static_cast<std::ptrdiff_t>(0.95 * double(d.size() - 1));
    std::nth_element(d.begin(), at, d.end());
    r.p95 = *at;
    r.normalized = nz > 0 ? std::sqrt(z2 / nz) : nan;
    out.push_back(std::move(r));
  }
  return out;
}

}  // namespace versine::track
