// SPDX-License-Identifier: Apache-2.0
#include "versine/track/fastenings.hpp"

#include <fmt/format.h>

#include <CbcModel.hpp>
#include <CbcSolver.hpp>
#include <CoinPackedMatrix.hpp>
#include <OsiClpSolverInterface.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace versine::track {
namespace {

/// A limit on a weighted sum of what is left at fastenings: |sum| <= bound, m.
struct Limit {
  std::vector<std::pair<std::size_t, double>> terms;
  double offset = 0.0;  ///< added to the sum: of the other rail
  double bound = 0.0;
  [[nodiscard]] std::size_t last() const {
    std::size_t k = 0;
    for (const auto& [i, w] : terms) k = std::max(k, i);
    return k;
  }
};

/// Adds the deviation at a place as terms; false where it is unknown.
bool add_place(std::span<const double> position, std::span<const double> deviation, double at, double weight,
               Limit& limit) {
  const auto above = std::lower_bound(position.begin(), position.end(), at - 1e-9);
  if (above == position.end()) return false;
  const auto k = static_cast<std::size_t>(above - position.begin());
  if (std::abs(position[k] - at) < 1e-6) {
    limit.terms.emplace_back(k, weight);
    return std::isfinite(deviation[k]);
  }
  if (k == 0 || !std::isfinite(deviation[k]) || !std::isfinite(deviation[k - 1])) return false;
  const double f = (at - position[k - 1]) / (position[k] - position[k - 1]);
  limit.terms.emplace_back(k - 1, weight * (1.0 - f));
  limit.terms.emplace_back(k, weight * f);
  return true;
}

/// Everything that must hold, in order of the last fastening concerned.
std::vector<Limit> limits_of(std::span<const double> position, std::span<const double> deviation,
                             const FasteningOptions& o, std::span<const double> other) {
  std::vector<Limit> out;
  for (std::size_t i = 0; i < position.size(); ++i) {
    if (!std::isfinite(deviation[i])) continue;
    out.push_back({{{i, 1.0}}, 0.0, o.deviation_limit});
    if (!other.empty() && std::isfinite(other[i])) out.push_back({{{i, 1.0}}, -other[i], o.difference_limit});
    for (std::size_t c = 0; c < o.checks.size(); ++c) {
      const ChordCheck& check = o.checks[c];
      const double f = check.distance / check.length, begin = position[i] - check.first;
      Limit limit{{}, 0.0, o.check_limits[c]};
      if (begin >= position.front() && add_place(position, deviation, begin, -f, limit) &&
          add_place(position, deviation, position[i], 1.0, limit) &&
          add_place(position, deviation, position[i] + check.distance, -1.0, limit) &&
          add_place(position, deviation, begin + check.length, f, limit)) {
        out.push_back(std::move(limit));
      }
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const Limit& a, const Limit& b) { return a.last() < b.last(); });
  return out;
}

int no_interruption(CbcModel*, int) {
  return 0;
}

/// One window: fastenings [first, whole) move in whole steps, those up to `last` in any, so that what comes stays
/// possible; those before `first` have their steps already.
class Window {
 public:
  Window(std::size_t first, std::size_t whole, std::size_t last, const FasteningOptions& o)
      : first_(first), whole_(whole), last_(last), o_(o) {
    const auto n = static_cast<int>(last - first), m = static_cast<int>(whole - first);
    // up and down of each fastening, moved of each one in whole steps, then slacks.
    const double up = std::floor(o.highest / o.step + 1e-9), down = std::floor(-o.lowest / o.step + 1e-9);
    // A movement in any steps costs its share of a moved fastening.
    for (int i = 0; i < n; ++i) add_column(0.0, up, i < m || up == 0.0 ? 0.01 : 0.01 + 1.0 / up, i < m);
    for (int i = 0; i < n; ++i) add_column(0.0, down, i < m || down == 0.0 ? 0.01 : 0.01 + 1.0 / down, i < m);
    for (int i = 0; i < m; ++i) {
      add_column(0.0, 1.0, 1.0, true);
      // A row for each direction is tighter than one for both.
      add_row({{i, 1.0}, {2 * n + i, -up}}, -1e30, 0.0);
      add_row({{n + i, 1.0}, {2 * n + i, -down}}, -1e30, 0.0);
    }
  }

  void forbid(std::size_t i) { upper_[at(i)] = upper_[at(i) + count()] = 0.0; }

  /// Neighbours' movements, in steps.
  void bend(std::size_t i, std::size_t k, const std::vector<int>& steps) {
    const double most = std::floor(o_.neighbour_limit / o_.step + 1e-9);
    std::vector<std::pair<int, double>> row;
    double known = 0.0;
    term(k, 1.0, steps, row, known);
    term(i, -1.0, steps, row, known);
    if (!row.empty()) add_row(row, -most - known, most - known);
  }

  void keep(const Limit& limit, std::span<const double> deviation, const std::vector<int>& steps) {
    std::vector<std::pair<int, double>> row;
    double known = 0.0, sum = limit.offset;
    for (const auto& [i, w] : limit.terms) {
      sum += w * deviation[i];
      term(i, w, steps, row, known);
    }
    if (row.empty()) return;
    known += sum / o_.step;
    const double bound = limit.bound / o_.step;
    // What cannot be met costs a hundred moved fastenings a step: no movement is spared for it.
    row.emplace_back(static_cast<int>(upper_.size()), 1.0);
    add_column(0.0, 1e30, 100.0, false);
    row.emplace_back(static_cast<int>(upper_.size()), -1.0);
    add_column(0.0, 1e30, 100.0, false);
    add_row(row, -bound - known, bound - known);
  }

  struct Found {
    std::vector<int> steps;
    double cost = 0.0, bound = 0.0;  ///< no plan costs less than the bound
  };

  /// Steps of the window's fastenings; nothing when Cbc finds none in its time.
  [[nodiscard]] std::optional<Found> solve() const {
    OsiClpSolverInterface osi;
    osi.messageHandler()->setLogLevel(0);
    CoinPackedMatrix matrix(false, row_.data(), column_.data(), value_.data(), static_cast<int>(value_.size()));
    matrix.setDimensions(static_cast<int>(row_low_.size()), static_cast<int>(upper_.size()));
    osi.loadProblem(matrix, lower_.data(), upper_.data(), cost_.data(), row_low_.data(), row_high_.data());
    for (std::size_t k = 0; k < integer_.size(); ++k) {
      if (integer_[k]) osi.setInteger(static_cast<int>(k));
    }
    CbcModel model(osi);
    model.setLogLevel(0);
    CbcSolverUsefulData data;
    data.noPrinting_ = true;
    CbcMain0(model, data);
    model.setLogLevel(0);
    const std::string seconds = fmt::format("{:g}", o_.seconds);
    const char* arguments[] = {"cbc", "-log", "0", "-seconds", seconds.c_str(), "-allow", "0.009", "-solve", "-quit"};
    CbcMain1(static_cast<int>(std::size(arguments)), arguments, model, no_interruption, data);
    const double* best = model.bestSolution();
    if (best == nullptr) return std::nullopt;
    Found out{std::vector<int>(whole_ - first_), model.getObjValue(), model.getBestPossibleObjValue()};
    for (std::size_t i = 0; i < out.steps.size(); ++i) {
      out.steps[i] = static_cast<int>(std::lround(best[i]) - std::lround(best[i + count()]));
    }
    return out;
  }

 private:
  [[nodiscard]] std::size_t count() const { return last_ - first_; }
  [[nodiscard]] std::size_t at(std::size_t i) const { return i - first_; }

  void term(std::size_t i, double weight, const std::vector<int>& steps, std::vector<std::pair<int, double>>& row,
            double& known) const {
    if (i < first_) {
      known += weight * steps[i];
      return;
    }
    row.emplace_back(static_cast<int>(at(i)), weight);
    row.emplace_back(static_cast<int>(at(i) + count()), -weight);
  }
  void add_column(double low, double high, double cost, bool integer) {
    lower_.push_back(low);
    upper_.push_back(high);
    cost_.push_back(cost);
    integer_.push_back(integer);
  }
  void add_row(const std::vector<std::pair<int, double>>& row, double low, double high) {
    for (const auto& [k, w] : row) {
      row_.push_back(static_cast<int>(row_low_.size()));
      column_.push_back(k);
      value_.push_back(w);
    }
    row_low_.push_back(low);
    row_high_.push_back(high);
  }

  std::size_t first_, whole_, last_;
  const FasteningOptions& o_;
  std::vector<double> lower_, upper_, cost_, value_, row_low_, row_high_;
  std::vector<int> row_, column_;
  std::vector<bool> integer_;
};

/// Where the search found nothing in its time: what the window before planned, and from there back to no movement as
/// fast as neighbours may differ. Nothing when a fastening that must not move is in the way.
std::optional<Window::Found> carried_on(const std::vector<int>& ahead, std::size_t first, std::size_t last,
                                        std::span<const double> deviation, const FasteningOptions& o) {
  if (ahead.empty()) return std::nullopt;
  const int most = static_cast<int>(std::floor(o.neighbour_limit / o.step + 1e-9));
  Window::Found out{ahead, std::numeric_limits<double>::infinity(), 0.0};
  out.steps.resize(std::min(out.steps.size(), last - first));
  while (out.steps.size() < last - first) {
    const int before = out.steps.back(), now = before > 0 ? std::max(0, before - most) : std::min(0, before + most);
    if (now != 0 && !std::isfinite(deviation[first + out.steps.size()])) return std::nullopt;
    out.steps.push_back(now);
  }
  return out;
}

Expected<void> check(std::span<const double> position, const FasteningOptions& o) {
  const bool rising = std::is_sorted(position.begin(), position.end(), std::less_equal<>());
  if (rising && o.step > 0.0 && o.lowest <= 0.0 && o.highest >= 0.0 && o.window > 0.0 && o.seconds > 0.0 &&
      o.check_limits.size() == o.checks.size()) {
    return {};
  }
  return fail({.field = "fastenings",
               .found = rising ? "options that contradict each other" : "positions that do not increase",
               .expected = "a step above 0, a range that holds 0, a limit for each check, increasing positions",
               .advice = "correct [geometry.fastenings]"});
}

}  // namespace

Expected<FasteningPlan> plan_fastenings(std::span<const double> position, std::span<const double> deviation,
                                        const FasteningOptions& o, std::span<const double> other_after) {
  if (auto good = check(position, o); !good) return tl::unexpected(good.error());
  const std::size_t n = position.size();
  FasteningPlan out;
  out.steps.assign(n, 0);
  out.after.assign(deviation.begin(), deviation.end());
  const std::vector<Limit> limits = limits_of(position, deviation, o, other_after);
  double open_cost = 0.0, open_bound = 0.0;  // of windows that are not proven
  double reach = 0.0;                        // how far a movement's consequences go
  for (const ChordCheck& check : o.checks) reach = std::max(reach, check.length);
  std::vector<int> ahead;  // what the window before planned for this one
  for (std::size_t first = 0; first < n;) {
    const auto until = [&](double length) {
      return static_cast<std::size_t>(std::upper_bound(position.begin(), position.end(), position[first] + length) -
                                      position.begin());
    };
    const std::size_t whole = until(o.window), last = until(o.window + reach);
    const std::size_t kept = whole == n ? n : std::max(first + 1, until(0.5 * o.window));
    Window window(first, whole, last, o);
    for (std::size_t i = first; i < last; ++i) {
      if (!std::isfinite(deviation[i])) window.forbid(i);
      if (i > 0) window.bend(i - 1, i, out.steps);
    }
    for (const Limit& limit : limits) {
      if (limit.last() >= first && limit.last() < last) window.keep(limit, deviation, out.steps);
    }
    auto found = window.solve();
    if (!found) found = carried_on(ahead, first, whole, deviation, o);
    if (!found) {
      return fail({.field = "fastenings",
                   .found = fmt::format("no plan from {:.1f} m within {:g} s", position[first], o.seconds),
                   .expected = "a plan for each window",
                   .advice = "allow more seconds, or a shorter window"});
    }
    for (std::size_t i = first; i < kept; ++i) out.steps[i] = found->steps[i - first];
    ahead.assign(found->steps.begin() + static_cast<std::ptrdiff_t>(kept - first), found->steps.end());
    ++out.windows;
    if (found->cost - found->bound < 0.01) {
      ++out.proven;
    } else if (std::isfinite(found->cost)) {
      open_cost += found->cost;
      open_bound += std::max(0.0, found->bound);
    }
    first = kept;
  }
  if (open_cost > 0.0) out.gap = 1.0 - open_bound / open_cost;
  for (std::size_t i = 0; i < n; ++i) {
    out.after[i] += o.step * out.steps[i];
    out.moved += out.steps[i] != 0;
  }
  for (const Limit& limit : limits) {
    double sum = limit.offset;
    for (const auto& [i, w] : limit.terms) sum += w * out.after[i];
    out.unreachable += std::abs(sum) > limit.bound + 1e-6;
  }
  return out;
}

}  // namespace versine::track
