// SPDX-License-Identifier: Apache-2.0
#include "versine/track/adjustment.hpp"

#include <fmt/format.h>

#include <ClpSimplex.hpp>
#include <CoinPackedMatrix.hpp>
#include <algorithm>
#include <cmath>

#include "versine/track/versine.hpp"

namespace versine::track {
namespace {

/// Problem on the coarse points of one window: movements x, bounds of |x|, |e + x|, |bend|, and slacks of checks.
struct Piece {
  std::vector<double> e;      // deviation before
  std::vector<char> fixed;    // movement must be zero
  std::vector<double> known;  // movements fixed by the window before; NaN: free
  bool at_start = false, at_end = false;
};

class Program {
 public:
  Program(const AdjustmentOptions& o, const Piece& w) : o_(o), w_(w), n_(static_cast<int>(w.e.size())) {
    for (int i = 0; i < n_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const bool zero = w.fixed[k] != 0 || (w.at_start && i == 0) || (w.at_end && i == n_ - 1);
      const double known = w.known[k];
      column(0.0, std::isfinite(known) ? known : (zero ? 0.0 : o.smallest),
             std::isfinite(known) ? known : (zero ? 0.0 : o.largest));
    }
    for (int i = 0; i < n_; ++i) column(1.0);              // |x|
    for (int i = 0; i < n_; ++i) column(o.design_weight);  // |e + x|
    for (int i = 0; i < n_; ++i) {
      const double e = w.e[static_cast<std::size_t>(i)];
      absolute(n_ + i, {{i, 1.0}}, 0.0);
      absolute(2 * n_ + i, {{i, 1.0}}, e);
      if (i > 0) add({{i, 1.0}, {i - 1, -1.0}}, -o.ramp * o.spacing, o.ramp * o.spacing);
    }
    for (int i = 1; i + 1 < n_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const int bend = column(o.smooth_weight);
      absolute(bend, {{i - 1, 0.5}, {i, -1.0}, {i + 1, 0.5}}, 0.5 * (w.e[k - 1] + w.e[k + 1]) - w.e[k]);
    }
    for (std::size_t c = 0; c < o.checks.size(); ++c)
      add_check(o.checks[c], 0.9 * o.check_limits[c]);  // the rest for between the points
  }

  std::vector<double> solve() {
    const CoinPackedMatrix matrix(true, row_.data(), col_.data(), value_.data(), static_cast<int>(value_.size()));
    ClpSimplex clp;
    clp.setLogLevel(0);
    clp.loadProblem(matrix, low_.data(), high_.data(), cost_.data(), row_low_.data(), row_high_.data());
    clp.dual();
    if (clp.status() != 0) clp.primal();
    const double* x = clp.primalColumnSolution();
    return {x, x + n_};
  }

 private:
  using Terms = std::vector<std::pair<int, double>>;

  int column(double cost, double low = 0.0, double high = COIN_DBL_MAX) {
    cost_.push_back(cost);
    low_.push_back(low);
    high_.push_back(high);
    return static_cast<int>(cost_.size()) - 1;
  }
  /// Terms of one column twice are summed up by the matrix.
  void add(const Terms& terms, double low, double high) {
    for (const auto& [i, v] : terms) {
      row_.push_back(static_cast<int>(row_low_.size()));
      col_.push_back(i);
      value_.push_back(v);
    }
    row_low_.push_back(low);
    row_high_.push_back(high);
  }
  /// bound >= |terms + constant|
  void absolute(int bound, Terms terms, double constant) {
    terms.emplace_back(bound, -1.0);
    add(terms, -COIN_DBL_MAX, -constant);
    for (auto& [i, v] : terms) v = i == bound ? 1.0 : v;
    add(terms, -constant, COIN_DBL_MAX);
  }
  void add_check(const ChordCheck& c, double limit) {
    const auto steps = [&](double d) { return static_cast<int>(std::lround(d / o_.spacing)); };
    const int first = steps(c.first), distance = steps(c.distance), length = steps(c.length);
    const int quiet = steps(o_.run_in);
    const double f = c.distance / c.length;
    for (int i = first; i - first + length < n_; ++i) {
      const int a = i - first, b = a + length, q = i + distance;
      if ((w_.at_start && a < quiet) || (w_.at_end && b > n_ - 1 - quiet)) continue;
      const auto e = [&](int k) { return w_.e[static_cast<std::size_t>(k)]; };
      const double now = e(i) - e(q) + f * (e(b) - e(a));
      const int slack = column(1e3);
      Terms t = {{i, 1.0}, {q, -1.0}, {b, f}, {a, -f}, {slack, -1.0}};
      add(t, -COIN_DBL_MAX, limit - now);
      t.back().second = 1.0;
      add(t, -limit - now, COIN_DBL_MAX);
    }
  }

  const AdjustmentOptions& o_;
  const Piece& w_;
  int n_;
  std::vector<double> cost_, low_, high_, row_low_, row_high_, value_;
  std::vector<int> row_, col_;
};

double worst(const std::vector<double>& v) {
  double w = 0.0;
  for (const double x : v) {
    if (std::isfinite(x)) w = std::max(w, std::abs(x));
  }
  return w;
}

}  // namespace

Expected<Adjustment> plan_adjustment(std::span<const double> mileage, std::span<const double> deviation, double step,
                                     const AdjustmentOptions& o) {
  const double ratio = o.spacing / step;
  if (o.smallest > 0.0 || o.largest < 0.0 || !(o.ramp > 0.0) || o.checks.size() != o.check_limits.size() ||
      std::abs(ratio - std::round(ratio)) > 1e-6 || ratio < 0.5) {
    return fail({.field = "adjustment",
                 .found = fmt::format("movement {:.4f} to {:.4f} m, ramp {:.5f}, spacing {} m on a grid of {} m",
                                      o.smallest, o.largest, o.ramp, o.spacing, step),
                 .expected = "bounds that hold zero, a positive ramp, a limit for each check, a spacing of whole steps",
                 .advice = "correct [geometry.adjustment]"});
  }
  const auto stride = static_cast<std::size_t>(std::llround(ratio));
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < mileage.size(); i += stride) at.push_back(i);
  const std::size_t n = at.size();
  Adjustment out;
  out.mileage.assign(mileage.begin(), mileage.end());
  out.before.assign(deviation.begin(), deviation.end());
  std::vector<double> x(n, 0.0);
  const auto window = std::max<std::size_t>(20, static_cast<std::size_t>(o.window / o.spacing)), hop = window / 2;
  for (std::size_t a = 0; n > 2; a += hop) {
    const std::size_t b = std::min(n, a + window);
    Piece w;
    w.at_start = a == 0;
    w.at_end = b == n;
    for (std::size_t k = a; k < b; ++k) {
      const double m = mileage[at[k]], e = deviation[at[k]];
      const bool still =
          std::any_of(o.fixed.begin(), o.fixed.end(), [&](const auto& f) { return m >= f.from && m <= f.to; });
      w.e.push_back(std::isfinite(e) ? e : 0.0);
      w.fixed.push_back(still || !std::isfinite(e) ? 1 : 0);
      // The first quarter of a later window is what the window before settled.
      w.known.push_back(a > 0 && k < a + hop / 2 ? x[k] : std::nan(""));
    }
    const std::vector<double> solved = Program(o, w).solve();
    for (std::size_t k = a; k < b; ++k)
      x[k] = std::clamp(solved[k - a], o.smallest, o.largest);  // Clp's tolerance is 1e-7
    if (b == n) break;
  }
  out.movement.assign(mileage.size(), 0.0);
  for (std::size_t k = 0; k + 1 < n; ++k) {
    for (std::size_t i = at[k]; i <= at[k + 1]; ++i) {
      const double f = double(i - at[k]) / double(stride);
      out.movement[i] = x[k] + f * (x[k + 1] - x[k]);
    }
  }
  out.after.resize(out.before.size());
  for (std::size_t i = 0; i < out.after.size(); ++i) out.after[i] = out.before[i] + out.movement[i];
  for (std::size_t c = 0; c < o.checks.size(); ++c) {
    const auto before = chord_check(out.before, step, o.checks[c]), after = chord_check(out.after, step, o.checks[c]);
    out.worst_before.push_back(worst(before));
    out.worst_after.push_back(worst(after));
    for (const double v : after) out.unreachable += std::abs(v) > 1.05 * o.check_limits[c] ? 1 : 0;
  }
  return out;
}

}  // namespace versine::track
