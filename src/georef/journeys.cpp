// SPDX-License-Identifier: Apache-2.0
#include "versine/georef/journeys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace versine::georef {

namespace {

/// Speed at each fix, from the receiver or from the displacement over two seconds around it.
std::vector<double> speeds(const Recording& r) {
  const auto& fixes = r.gnss.samples;
  std::vector<double> out;
  out.reserve(fixes.size());
  std::size_t a = 0, b = 0;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    while (a < i && (fixes[i].time - fixes[a].time).seconds() > 1.01) ++a;
    b = std::max(b, i);
    while (b + 1 < fixes.size() && (fixes[b + 1].time - fixes[i].time).seconds() < 1.01) ++b;
    const double dt = (fixes[b].time - fixes[a].time).seconds();
    if (fixes[i].speed) {
      out.push_back(*fixes[i].speed);
    } else {
      out.push_back(dt > 0.5 ? (fixes[b].place - fixes[a].place).norm() / dt : (out.empty() ? 99.0 : out.back()));
    }
  }
  return out;
}

/// Whether a movement continues the journey before it: its first 40 m do not lead back along the other's last
/// 40 m (a reversal turns by nearly 180 degrees, a receiver astray in a tunnel by anything).
bool goes_on(const Recording& r, const JourneySpan& before, std::size_t begin, std::size_t end) {
  if (!before.ends_standing) return false;
  constexpr double far = 40.0;
  // Steps of a second or two only: over a longer gap the position may have jumped.
  const auto heading = [&](std::size_t from, std::ptrdiff_t by, std::size_t limit) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t i = from; i != limit && sum.norm() < far; i += static_cast<std::size_t>(by)) {
      const std::size_t next = i + static_cast<std::size_t>(by), a = std::min(i, next), b = std::max(i, next);
      const double dt = (r.gnss[b].time - r.gnss[a].time).seconds();
      const Eigen::Vector2d step = r.gnss[b].place - r.gnss[a].place;
      if (dt < 2.0 && step.norm() < 60.0 * dt) sum += step;
    }
    return sum;
  };
  const Eigen::Vector2d in = heading(before.last, -1, before.first), out = heading(begin, 1, end);
  return in.norm() > 0.3 * far && out.norm() > 0.3 * far && in.dot(out) > -0.5 * in.norm() * out.norm();
}

constexpr double longest_step = 5.0;  // s between speeds that a distance is summed up from

/// Metres between two times as an odometer tells; NaN where it has a gap or was not running.
double travelled_between(const Series<sensors::SpeedSample>& speed, Time from, Time to) {
  if (speed.size() < 2 || from < speed.samples.front().time || speed.samples.back().time < to) return NAN;
  const std::size_t first = speed.lower_bound(from);
  double sum = 0.0;
  for (std::size_t k = first > 0 ? first - 1 : 0; speed[k].time < to; ++k) {
    const auto &a = speed[k], &b = speed[k + 1];
    const double dt = (b.time - a.time).seconds();
    if (dt > longest_step) return NAN;
    const auto at = [&](Time t) {
      return std::lerp(std::abs(a.speed), std::abs(b.speed), (t - a.time).seconds() / dt);
    };
    const Time begin = std::max(a.time, from), end = std::min(b.time, to);
    sum += 0.5 * (at(begin) + at(end)) * (end - begin).seconds();
  }
  return sum;
}

/// The same between two fixes, from the receiver's speeds where there is no odometer.
double travelled_between(const Recording& r, std::size_t from, std::size_t to) {
  const Fix &a = r.gnss[from], &b = r.gnss[to];
  if (const double d = travelled_between(r.speed, a.time, b.time); std::isfinite(d)) return d;
  const double dt = (b.time - a.time).seconds();
  return a.speed && b.speed && dt <= longest_step ? 0.5 * (*a.speed + *b.speed) * dt : NAN;
}

}  // namespace

std::size_t mark_astray(const Map& map, Recording& r, double radius) {
  std::size_t count = 0;
  for (auto& f : r.gnss.samples) {
    if (f.sigma > radius || !map.index.near(f.place, radius).empty()) continue;
    f.sigma = 2.0 * radius;
    ++count;
  }
  return count;
}

double fix_sigma(const Fix& fix, const GnssModel& model) {
  const double told = fix.sigma > 0.0 ? fix.sigma : model.sigma_of_type[static_cast<std::size_t>(fix.type)];
  return std::max(model.scale * told, model.floor);
}

std::vector<JourneySpan> find_journeys(const Recording& r, const JourneyOptions& options, RunRecord& record) {
  const auto& fixes = r.gnss.samples;
  const auto speed = speeds(r);
  std::vector<JourneySpan> out;
  const auto at = [&](std::size_t i) { return fixes[i].time; };
  const auto unbroken = [&](std::size_t i) { return (at(i) - at(i - 1)).seconds() <= options.longest_gap; };
  constexpr double stop = 3.0, lead = 20.0;  // s: shortest standstill, and how much of it is kept
  std::size_t i = 0, previous_end = 0;
  bool moved = false;  // since the last journey
  while (i < fixes.size()) {
    while (i < fixes.size() && speed[i] < options.standing) ++i;
    if (i == fixes.size()) break;
    const std::size_t begin = i;
    std::size_t end = i;  // last moving fix
    double fastest = 0.0;
    bool gap = false;
    for (; i < fixes.size(); ++i) {
      if (i > begin && !unbroken(i)) {
        gap = true;
        record.findings.push_back({"gnss", "gap", at(i - 1), at(i), 1, Finding::Action::split,
                                   fmt::format("{:.0f} s without a fix", (at(i) - at(i - 1)).seconds())});
        break;
      }
      if (speed[i] >= options.standing) {
        end = i;
        fastest = std::max(fastest, speed[i]);
      } else if ((at(i) - at(end)).seconds() > stop && i > end + 2) {
        break;
      }
    }
    JourneySpan span{.first = begin,
                     .last = end,
                     .starts_standing = begin > previous_end && unbroken(begin),
                     .ends_standing = !gap && i < fixes.size()};
    // The vehicle may have started long after its last standing fix, when that one was before a tunnel.
    const Time stands_until = span.starts_standing ? at(begin - 1) : Time{};
    const Time stands_from = span.ends_standing ? at(end + 1) : Time{};
    while (span.starts_standing && span.first > previous_end && unbroken(span.first) &&
           (stands_until - at(span.first - 1)).seconds() < lead)
      --span.first;
    while (span.ends_standing && span.last + 1 < fixes.size() && unbroken(span.last + 1) &&
           speed[span.last + 1] < options.standing && (at(span.last + 1) - stands_from).seconds() < lead) {
      ++span.last;
    }
    if (span.starts_standing) span.stops.push_back({at(span.first) - Duration::from_seconds(5.0), stands_until});
    if (span.ends_standing) span.stops.push_back({stands_from, at(span.last) + Duration::from_seconds(5.0)});
    previous_end = span.last;
    if (!((at(end) - at(begin)).seconds() > options.shortest && fastest > options.slowest)) {
      moved = true;  // too short for a journey of its own
    } else if (!options.every_stop && !out.empty() && goes_on(r, out.back(), begin, end)) {
      JourneySpan& before = out.back();
      if (!before.stops.empty() && span.starts_standing) before.stops.back().until = stands_until;
      if (span.ends_standing) before.stops.push_back(span.stops.back());
      before.last = span.last;
      before.ends_standing = span.ends_standing;
    } else {
      span.goes_on = !out.empty() && out.back().ends_standing && span.starts_standing && !moved;
      out.push_back(span);
      moved = false;
    }
    i = std::max(i, end + 1);
  }
  return out;
}

std::vector<Knot> make_knots(const Recording& r, const JourneySpan& span, const Options& options) {
  std::vector<Knot> out;
  double travelled = 0.0;  // since the last knot; NaN: not known
  for (std::size_t i = span.first; i <= span.last; ++i) {
    const Fix& f = r.gnss[i];
    if (i > span.first) travelled += travelled_between(r, i - 1, i);
    const Eigen::Vector2d& p = f.place;
    const double sigma = fix_sigma(f, options.gnss);
    const bool first = out.empty(), last = i == span.last;
    const double since = first ? 0.0 : (f.time - out.back().time).seconds();
    // Far enough from the one before, or standing for long; a better fix replaces a worse one at the same place.
    if (!first && !last && (p - out.back().point).norm() < options.inference.knot_distance + sigma && since < 30.0)
      continue;
    const double weight = first ? 1.0 : std::clamp(since / options.gnss.correlation_time * 2.0, 0.2, 1.0);
    out.push_back({f.time, p, std::hypot(sigma, options.gnss.map_sigma), weight,
                   !first && std::isfinite(travelled) ? travelled : -1.0});
    travelled = 0.0;
  }
  return out;
}

}  // namespace versine::georef
