// SPDX-License-Identifier: Apache-2.0
#include "versine/gnss/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "versine/geodesy/ellipsoid.hpp"

namespace versine::gnss {
namespace {

using sensors::FixType;
using sensors::GnssSample;

/// The samples of one direction in order of time (a backward pass writes them in its own).
std::vector<GnssSample> sorted(const Series<GnssSample>& series) {
  std::vector<GnssSample> s = series.samples;
  std::sort(s.begin(), s.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  return s;
}

const GnssSample* at(const std::vector<GnssSample>& s, Time t) {
  const auto it = std::lower_bound(s.begin(), s.end(), t, [](const auto& a, Time x) { return a.time < x; });
  return it != s.end() && it->time == t ? &*it : nullptr;
}

/// The difference when it is too large, else nothing.
std::optional<Eigen::Vector3d> contradiction(const GnssSample& a, const GnssSample& b, const AgreementOptions& o) {
  const Eigen::Vector3d d = geodesy::wgs84.ned_difference(a.position, b.position);
  const Eigen::Vector3d sigma = (a.sigma_ned.cwiseAbs2() + b.sigma_ned.cwiseAbs2()).cwiseSqrt();
  const bool significant = (d.cwiseAbs().array() > o.sigmas * sigma.array()).any();
  if (d.norm() > o.distance && significant) return d;
  return {};
}

}  // namespace

Agreement compare_directions(Series<GnssSample> combined, const Series<GnssSample>& forward,
                             const Series<GnssSample>& backward, const AgreementOptions& options) {
  Agreement out{.series = std::move(combined)};
  const auto f = sorted(forward), b = sorted(backward);
  Finding* open = nullptr;
  for (GnssSample& s : out.series.samples) {
    const GnssSample *x = at(f, s.time), *y = at(b, s.time);
    const bool fixed_x = x != nullptr && x->fix == FixType::fixed, fixed_y = y != nullptr && y->fix == FixType::fixed;
    if (s.fix == FixType::fixed) ++out.fixed;
    const auto apart =
        x != nullptr && y != nullptr && (fixed_x || fixed_y) ? contradiction(*x, *y, options) : std::nullopt;
    if (!apart) {
      if (s.fix == FixType::fixed && fixed_x && fixed_y) {
        ++out.confirmed;
        // Both directions see the same phases: their mean is no better than one of them.
        s.sigma_ned = s.sigma_ned.cwiseMax(x->sigma_ned.cwiseMin(y->sigma_ned));
      }
      open = nullptr;
      continue;
    }
    ++out.doubted;
    if (s.fix == FixType::fixed) s.fix = FixType::float_ambiguity;
    s.sigma_ned = s.sigma_ned.cwiseMax(apart->cwiseAbs());
    if (open == nullptr) {
      out.findings.push_back({.sensor = "gnss", .kind = "forward and backward disagree", .from = s.time});
      open = &out.findings.back();
    }
    open->to = s.time;
    ++open->count;
    open->detail =
        fmt::format("last difference {:.3f} m north, {:.3f} m east, {:.3f} m down", apart->x(), apart->y(), apart->z());
  }
  return out;
}

}  // namespace versine::gnss
