// SPDX-License-Identifier: Apache-2.0
#include "versine/app/view_series.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace versine::app {

namespace {

constexpr std::size_t factor = 4;
constexpr std::size_t coarsest = 100;  // a level of fewer buckets would be of no use to any screen
constexpr float half95 = 1.96f;

template <class Better>
std::vector<float> fold(const std::vector<float>& fine, Better better) {
  std::vector<float> out((fine.size() + factor - 1) / factor, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < fine.size(); ++i) {
    float& best = out[i / factor];
    if (!std::isnan(fine[i]) && (std::isnan(best) || better(fine[i], best))) best = fine[i];
  }
  return out;
}

void put(std::string& out, std::uint32_t value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}
template <class T>
void put(std::string& out, const std::vector<T>& values, std::size_t a, std::size_t b) {
  out.append(reinterpret_cast<const char*>(values.data() + a), (b - a) * sizeof(T));
}

/// Samples between two places and one on each side.
std::pair<std::size_t, std::size_t> between(const std::vector<double>& x, double from, double to) {
  const auto a = static_cast<std::size_t>(std::lower_bound(x.begin(), x.end(), from) - x.begin());
  const auto b = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), to) - x.begin());
  return {a > 0 ? a - 1 : 0, std::max(a > 0 ? a - 1 : 0, std::min(x.size(), b + 1))};
}

}  // namespace

static_assert(std::endian::native == std::endian::little, "the page reads little-endian numbers");

ViewSeries::ViewSeries(Places x, const std::vector<double>& value, const std::vector<double>& sigma)
    : x_(std::move(x)), value_(value.begin(), value.end()), sigma_(sigma.begin(), sigma.end()) {
  if (value_.size() <= coarsest * factor) return;
  Level samples{*x_, value_, value_, {}, {}};
  for (std::size_t i = 0; i < sigma_.size(); ++i) {
    samples.lower.push_back(value_[i] - half95 * sigma_[i]);
    samples.upper.push_back(value_[i] + half95 * sigma_[i]);
  }
  levels_.push_back(coarser(samples));
  while (levels_.back().x.size() > coarsest * factor) levels_.push_back(coarser(levels_.back()));
}

ViewSeries::Level ViewSeries::coarser(const Level& fine) {
  const auto less = [](float a, float b) { return a < b; };
  const auto more = [](float a, float b) { return a > b; };
  Level out{{}, fold(fine.min, less), fold(fine.max, more), fold(fine.lower, less), fold(fine.upper, more)};
  for (std::size_t i = 0; i < fine.x.size(); i += factor) out.x.push_back(fine.x[i]);
  return out;
}

std::string ViewSeries::encode(double from, double to, std::size_t buckets) const {
  std::string out;
  const auto [a, b] = between(*x_, from, to);
  if (buckets == 0 || b - a <= buckets || levels_.empty()) {
    put(out, static_cast<std::uint32_t>(b - a));
    put(out, sigma_.empty() ? 2u : 3u);
    put(out, *x_, a, b);
    put(out, value_, a, b);
    if (!sigma_.empty()) put(out, sigma_, a, b);
    return out;
  }
  for (const Level& level : levels_) {
    const auto [c, d] = between(level.x, from, to);
    if (d - c > buckets && &level != &levels_.back()) continue;
    put(out, static_cast<std::uint32_t>(d - c));
    put(out, sigma_.empty() ? 0u : 1u);
    put(out, level.x, c, d);
    put(out, level.min, c, d);
    put(out, level.max, c, d);
    if (!sigma_.empty()) {
      put(out, level.lower, c, d);
      put(out, level.upper, c, d);
    }
    break;
  }
  return out;
}

std::optional<ViewSeries::Sample> ViewSeries::at(double x) const {
  if (value_.empty()) return std::nullopt;
  auto i = static_cast<std::size_t>(std::lower_bound(x_->begin(), x_->end(), x) - x_->begin());
  if (i == value_.size() || (i > 0 && x - (*x_)[i - 1] < (*x_)[i] - x)) --i;
  return Sample{(*x_)[i], value_[i], sigma_.empty() ? std::numeric_limits<float>::quiet_NaN() : sigma_[i]};
}

}  // namespace versine::app
